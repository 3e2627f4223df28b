#pragma once
// What a build under a sanitizer leaves out: bounds by the clock or by resident memory, and statistics over many runs of code
// that other tests run, too.
namespace echopath::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kIsSanitized = true;
#else
inline constexpr bool kIsSanitized = false;
#endif

}  // namespace echopath::test
