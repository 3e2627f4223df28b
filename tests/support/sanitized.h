#pragma once
// What a build under a sanitizer leaves out: bounds by the clock or by resident memory, and statistics over many runs of
// code that other tests run, too.
namespace echopath::test {

#ifdef ECHOPATH_SANITIZED
inline constexpr bool kIsSanitized = true;
#else
inline constexpr bool kIsSanitized = false;
#endif

}  // namespace echopath::test
