#pragma once
#include <pybind11/pybind11.h>

namespace echopath::bindings {

// The one table from exceptions of the core to those of Python:
//   FileError -> echopath.FileError (an OSError), DeviceError -> echopath.DeviceError (a RuntimeError),
//   Cancelled -> KeyboardInterrupt. pybind11 itself brings std::invalid_argument -> ValueError and
//   std::out_of_range -> IndexError.
void register_errors(pybind11::module_& m);

}  // namespace echopath::bindings
