#pragma once
// Python objects that values of the core carry along without knowing them.
#include <pybind11/pybind11.h>

#include <memory>

namespace echopath::bindings {

// Returns a holder of the object that any thread may copy and let go of, without the GIL, too: what is let go of is given
// back to Python at the next call. None gives null. Called with the GIL.
std::shared_ptr<const void> hold(const pybind11::object& object);

// Returns the object of a holder, None for null. Called with the GIL.
pybind11::object held(const std::shared_ptr<const void>& holder);

}  // namespace echopath::bindings
