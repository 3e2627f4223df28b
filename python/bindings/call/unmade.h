#pragma once
#include <pybind11/pybind11.h>

namespace echopath::bindings {

// Has every use of an object whose __init__ has not run yet raise TypeError, of all classes in `m`. A class of Python may
// override __init__ and read itself before it calls that of its base; pybind11 would then give the object memory that
// nothing has been written to, and read it.
void refuse_unmade(const pybind11::module_& m);

}  // namespace echopath::bindings
