#include "values/travel.h"

namespace echopath::bindings {

void require_fields(const py::dict& state, const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (!state.contains(name)) throw py::value_error("state: must have the field '" + name + "', which is missing");
  }
  for (const auto& [key, value] : state) {
    const auto name = py::str(key).cast<std::string>();
    if (std::ranges::find(names, name) == names.end())
      throw py::value_error("state: must have fields that are known, got '" + name + "'");
  }
}

}  // namespace echopath::bindings
