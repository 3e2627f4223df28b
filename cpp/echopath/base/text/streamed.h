#pragma once
// Writes values one behind the other into a text.
#include <sstream>
#include <string>

namespace echopath {

// Returns what a stream makes of the parts.
template <class... Parts>
std::string streamed(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

// Returns a count with the word for one thing or for several.
template <class Count>
std::string counted(Count count, const std::string& thing, const std::string& several) {
  return std::to_string(count) + " " + (count == 1 ? thing : several);
}
template <class Count>
std::string counted(Count count, const std::string& thing) {
  return counted(count, thing, thing + "s");
}

// Returns a number with so many significant digits.
inline std::string with_digits(int digits, double number) {
  std::ostringstream text;
  text.precision(digits);
  text << number;
  return text.str();
}

}  // namespace echopath
