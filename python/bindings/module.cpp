// The extension echopath._core. The build lists the modules to bind, types before their uses, in ECHOPATH_BIND_MODULES:
// X(base) X(motion) ... Each has a file bind_<module>.cpp.
#include <pybind11/pybind11.h>

#include "call/errors.h"
#include "call/leaving.h"
#include "call/unmade.h"

namespace echopath::bindings {

#define X(module) void bind_##module(pybind11::module_& m);
ECHOPATH_BIND_MODULES
#undef X

}  // namespace echopath::bindings

PYBIND11_MODULE(_core, m) {
  namespace bindings = echopath::bindings;
  m.doc() = "The C++ core of echopath; use it through the package.";
  m.attr("__version__") = ECHOPATH_VERSION;
  bindings::register_errors(m);
  bindings::register_leaving();
#define X(module) bindings::bind_##module(m);
  ECHOPATH_BIND_MODULES
#undef X
  bindings::refuse_unmade(m);
}
