#pragma once
// What a program with sanitized modules leaves out: bounds by the clock or by resident memory, and statistics over many runs
// of code that other tests run, too. The objects of the tests are the same with and without sanitizers.

// NOLINTBEGIN(bugprone-reserved-identifier): the sanitizers' own names, which are there where one is linked
extern "C" void __asan_init() __attribute__((weak));
extern "C" void __tsan_init() __attribute__((weak));
// NOLINTEND(bugprone-reserved-identifier)

namespace echopath::test {

inline const bool kThreadsAreWatched = &__tsan_init != nullptr;
inline const bool kIsSanitized = &__asan_init != nullptr || kThreadsAreWatched;

}  // namespace echopath::test
