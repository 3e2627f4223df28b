#pragma once
// Structs as rows of NumPy. A Pass is flat there: it has a Hit within, which a structured array cannot name.
#include <pybind11/numpy.h>

#include <string>
#include <vector>

#include "call/argument.h"
#include "echopath/base/text/streamed.h"
#include "echopath/record/paths.h"
#include "values/array.h"

namespace echopath::bindings {

template <class Row>
using StructuredArray = py::array_t<Row, py::array::c_style | py::array::forcecast>;

// The value as a structured array [N] of those rows; otherwise raises TypeError by the rule.
template <class Row>
StructuredArray<Row> structured_array(py::handle value, const char* argument, const char* rule) {
  if (!py::isinstance<py::array>(value)) refuse_type(argument, rule, value);
  const auto given = py::reinterpret_borrow<py::array>(value);
  if (given.ndim() == 1 && given.dtype().equal(py::dtype::of<Row>())) return given;
  throw py::type_error(
      streamed(argument, ": ", rule, ", got ", std::string(py::str(given.dtype())), " of ", given.ndim(), " dimensions"));
}

// As Paths.passes has them.
struct PassRow {
  uint32_t mesh_id, triangle_id;
  float u, v;
  uint32_t leg;
};
static_assert(sizeof(PassRow) == sizeof(Pass));

inline py::array passes_of(const py::object& self) {
  const auto& passes = self.cast<const Paths&>().passes;
  const auto* rows = reinterpret_cast<const PassRow*>(passes.data());
  return numpy_view(rows, {std::ssize(passes)}, self);
}

// [N] structured, as Paths.passes has them.
struct PassRows {
  using Value = std::vector<Pass>;
  static constexpr auto type_name = py::detail::const_name("ArrayLike");
  static Value from(py::handle value, const char* argument) {
    constexpr const char* kRule = "must be an array [N] of (mesh_id, triangle_id, u, v, leg) as Paths.passes has it";
    const StructuredArray<PassRow> rows = structured_array<PassRow>(value, argument, kRule);
    Value passes;
    // NumPy takes structs for aligned at any address: they are copied before they are read.
    for (const PassRow& row : vector_of(rows)) passes.push_back({{row.mesh_id, row.triangle_id, row.u, row.v}, row.leg});
    return passes;
  }
};

}  // namespace echopath::bindings
