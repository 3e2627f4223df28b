#pragma once
#include <pybind11/pybind11.h>

namespace echopath::bindings {

// Has all functions and methods of a module, made so far, refuse keywords that are no Unicode text (lone surrogates) by
// TypeError. pybind11 lets the error that it meets with them while it words another one end the process.
void refuse_keywords_without_text(const pybind11::module_& m);

}  // namespace echopath::bindings
