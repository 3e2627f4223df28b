#pragma once
// Paths of arrays, as files and pickles keep them.
#include <pybind11/pybind11.h>

#include <memory>

#include "echopath/record/paths.h"

namespace echopath::bindings {

using PathsPtr = std::shared_ptr<Paths>;
using PathsClass = pybind11::class_<Paths, PathsPtr>;

// Binds Paths.from_arrays, and the pickle that it reads.
void bind_from_arrays(PathsClass& type);

}  // namespace echopath::bindings
