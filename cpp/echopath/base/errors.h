#pragma once
// Defines the exceptions of the core. Python shows std::invalid_argument -> ValueError, std::out_of_range -> IndexError,
// FileError -> OSError, DeviceError -> RuntimeError, Cancelled -> KeyboardInterrupt.
#include <complex>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

namespace echopath {

struct FileError : std::runtime_error {  // a file is missing, damaged, or cannot be written
  using std::runtime_error::runtime_error;
};
struct DeviceError : std::runtime_error {  // Embree or the machine failed, not the input
  using std::runtime_error::runtime_error;
};
struct Cancelled : std::runtime_error {  // the caller asked a long computation to stop
  Cancelled() : std::runtime_error("cancelled") {}
};

// Returns how many significant digits tell a number from its neighbours: 15 do for one that was typed, so that 0.1 is not
// said to be 0.10000000000000001.
inline int digits_of(double number) {
  for (const int digits : {15, 16}) {
    std::ostringstream text;
    text.precision(digits);
    text << number;
    if (std::strtod(text.str().c_str(), nullptr) == number) return digits;
  }
  return 17;
}

// Writes a value as it was typed: 0.1, and 4+0.1j of complex numbers.
template <class Value>
void write_typed(std::ostream& text, const Value& value) {
  text.precision(17);
  if constexpr (std::is_floating_point_v<Value>) text.precision(digits_of(value));
  text << value;
}

inline void write_typed(std::ostream& text, const std::complex<double>& value) {
  write_typed(text, value.real());
  text << std::showpos;
  write_typed(text, value.imag());
  text << std::noshowpos << "j";
}

// Raises std::invalid_argument("<argument>: <rule>, got <value>") unless `holds`.
template <class Value>
void require(bool holds, std::string_view argument, std::string_view rule, const Value& value) {
  if (holds) return;
  std::ostringstream text;
  text << argument << ": " << rule << ", got ";
  write_typed(text, value);
  throw std::invalid_argument(text.str());
}

}  // namespace echopath
