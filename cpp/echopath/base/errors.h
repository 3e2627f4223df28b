#pragma once
// Defines the exceptions of the core. Python shows std::invalid_argument -> ValueError, std::out_of_range -> IndexError,
// FileError -> OSError, DeviceError -> RuntimeError, Cancelled -> KeyboardInterrupt.
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>

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

// Raises std::invalid_argument("<argument>: <rule>, got <value>") unless `holds`.
template <class Value>
void require(bool holds, std::string_view argument, std::string_view rule, const Value& value) {
  if (holds) return;
  std::ostringstream text;
  text.precision(17);
  text << argument << ": " << rule << ", got " << value;
  throw std::invalid_argument(text.str());
}

}  // namespace echopath
