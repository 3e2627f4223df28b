#pragma once
// What Python raises while an argument is looked at.
#include <pybind11/numpy.h>

namespace echopath::bindings {

// Forgets what Python has raised, if anything: the argument is at fault, and the caller's own message tells it better. What
// is no fault of an argument, such as Ctrl-C or a lack of memory, goes on as pybind11::error_already_set.
void forget_fault();

// Whether a value has an attribute; what is no fault of the value goes on as in `forget_fault`.
bool has_attribute(pybind11::handle value, const char* name);

// `value` as NumPy takes it for an array; a null handle, and no error, where NumPy does not take it. What is no fault of
// the value goes on as in `forget_fault`.
pybind11::array array_or_none(pybind11::handle value);

}  // namespace echopath::bindings
