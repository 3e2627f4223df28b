#include "values/array.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include "call/faults.h"
#include "call/shown.h"
#include "echopath/base/errors.h"
#include "echopath/base/text/streamed.h"

namespace echopath::bindings {
namespace {

constexpr py::ssize_t kAnySize = -1;
// A quaternion nearer to length 1 than this is left alone, so that values read back keep their bits.
constexpr double kUnitRounding = 1e-14;

static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(IndexTriple) == 3 * sizeof(uint32_t));

// "[V, 3]" -> {kAnySize, 3}.
Shape parse_shape(std::string_view text) {
  Shape shape;
  std::string size;
  std::istringstream sizes{std::string(text.substr(1, text.size() - 2))};
  while (std::getline(sizes >> std::ws, size, ','))
    shape.push_back(std::isdigit(static_cast<unsigned char>(size[0])) ? std::stol(size) : kAnySize);
  return shape;
}

bool fits(const py::array& array, const Shape& shape) {
  if (array.ndim() != std::ssize(shape)) return false;
  for (size_t k = 0; k < shape.size(); ++k)
    if (shape[k] != kAnySize && shape[k] != array.shape(static_cast<py::ssize_t>(k))) return false;
  return true;
}

std::string rule(std::string_view argument, std::string_view shape, std::string_view what) {
  if (shape == "[]") return streamed(argument, ": must be a single value (", what, "), got ");
  return streamed(argument, ": must be an array ", shape, " of ", what, ", got ");
}

// Whether some values of a numpy.ma.MaskedArray are masked: what stands in their places means nothing.
bool is_masked(py::handle value) {
  return has_attribute(value, "mask") && py::isinstance<py::array>(value) &&
         py::module_::import("numpy.ma").attr("is_masked")(value).cast<bool>();
}

Vec3 vec3_at(const double* numbers) { return {numbers[0], numbers[1], numbers[2]}; }

Quaternion quaternion_at(const double* wxyz, std::string_view argument) {
  Quaternion q(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
  const double length = q.norm();
  require(std::abs(length - 1.0) <= kUnitTolerance, argument, "must be quaternions (w, x, y, z) of length 1", length);
  if (std::abs(length - 1.0) > kUnitRounding) q.normalize();
  return q;
}

void put(const Quaternion& q, double* wxyz) {
  wxyz[0] = q.w();
  wxyz[1] = q.x();
  wxyz[2] = q.y();
  wxyz[3] = q.z();
}

template <class Number, class Row>
py::array_t<Number> rows_to_numpy(const std::vector<Row>& rows) {
  constexpr auto kColumns = static_cast<py::ssize_t>(sizeof(Row) / sizeof(Number));
  py::array_t<Number> array({std::ssize(rows), kColumns});
  Number* to = array.mutable_data();
  for (const Row& row : rows) to = std::copy_n(row.data(), kColumns, to);
  return array;
}

// The rows of a table as structs of as many numbers.
template <class Row, class T>
std::vector<Row> as_rows(const py::array_t<T, py::array::c_style>& table) {
  std::vector<Row> rows(table.shape(0));
  if (!rows.empty()) std::memcpy(rows.data()->data(), table.data(), rows.size() * sizeof(Row));
  return rows;
}

}  // namespace

namespace detail {

py::array array_of_kind(py::handle value, std::string_view argument, std::string_view shape, std::string_view kinds,
                        std::string_view what) {
  const py::array array = array_or_none(value);
  if (!array) throw py::type_error(rule(argument, shape, what) + shown(value));
  if (is_masked(value))
    throw py::value_error(rule(argument, shape, what) + "a masked array, some of whose values are not there");
  // An empty list has no kind of its own.
  if (array.size() > 0 && kinds.find(array.dtype().kind()) == std::string_view::npos)
    throw py::type_error(rule(argument, shape, what) + shown(array && array.ndim() > 0 ? py::handle(array) : value));
  if (!fits(array, parse_shape(shape)))
    throw py::value_error(rule(argument, shape, what) + shown(array && array.ndim() > 0 ? py::handle(array) : value));
  return array;
}

void require_range(const py::array& array, std::string_view argument, int64_t low, uint64_t high) {
  if (array.size() == 0) return;
  const py::object smallest = array.attr("min")().attr("item")(), largest = array.attr("max")().attr("item")();
  const std::string rule = "must lie in " + std::to_string(low) + " to " + std::to_string(high);
  require(smallest >= py::int_(low), argument, rule, std::string(py::str(smallest)));
  require(largest <= py::int_(high), argument, rule, std::string(py::str(largest)));
}

}  // namespace detail

Vec3 as_vec3(py::handle value, std::string_view argument) {
  const Vec3 point = vec3_at(checked_array<double>(value, argument, "[3]").data());
  require(point.allFinite(), argument, "must be finite", point.transpose());
  return point;
}

std::vector<Vec3> as_points(py::handle value, std::string_view argument) {
  return as_rows<Vec3>(checked_array<double>(value, argument, "[N, 3]"));
}

std::vector<std::vector<Vec3>> as_frames(py::handle value, std::string_view argument) {
  const auto array = checked_array<double>(value, argument, "[T, V, 3]");
  const auto num_vertices = static_cast<size_t>(array.shape(1));
  std::vector<std::vector<Vec3>> frames(array.shape(0), std::vector<Vec3>(num_vertices));
  for (size_t t = 0; t < frames.size(); ++t)
    for (size_t v = 0; v < num_vertices; ++v) frames[t][v] = vec3_at(array.data() + 3 * (t * num_vertices + v));
  return frames;
}

std::vector<IndexTriple> as_triangles(py::handle value, std::string_view argument) {
  return as_rows<IndexTriple>(checked_array<uint32_t>(value, argument, "[F, 3]"));
}

std::vector<IndexPair> as_pairs(py::handle value, std::string_view argument) {
  return as_rows<IndexPair>(checked_array<int64_t>(value, argument, "[N, 2]"));
}

Transform as_transform(py::handle value, std::string_view argument) {
  const auto array = checked_array<double>(value, argument, "[4, 4]");
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(array.data());
  for (Eigen::Index row = 0; row < 3; ++row) {
    require(matrix.row(row).allFinite(), argument, "must be finite, in row " + std::to_string(row), matrix.row(row));
  }
  require(matrix.row(3) == Eigen::RowVector4d(0, 0, 0, 1), argument, "must have the last row 0 0 0 1", matrix.row(3));
  Transform transform;
  transform.matrix() = matrix;
  return transform;
}

Quaternion as_quaternion(py::handle value, std::string_view argument) {
  return quaternion_at(checked_array<double>(value, argument, "[4]").data(), argument);
}

std::vector<Quaternion> as_quaternions(py::handle value, std::string_view argument) {
  const auto array = checked_array<double>(value, argument, "[N, 4]");
  std::vector<Quaternion> quaternions;
  quaternions.reserve(array.shape(0));
  for (py::ssize_t i = 0; i < array.shape(0); ++i) quaternions.push_back(quaternion_at(array.data() + 4 * i, argument));
  return quaternions;
}

py::array_t<double> to_numpy(const Vec3& value) { return py::array_t<double>(3, value.data()); }

py::array_t<double> to_numpy(const Quaternion& value) {
  py::array_t<double> array(4);
  put(value, array.mutable_data());
  return array;
}

py::array_t<double> to_numpy(const Transform& value) {
  py::array_t<double> array({4, 4});
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(array.mutable_data()) = value.matrix();
  return array;
}

py::array_t<double> to_numpy(const std::vector<Vec3>& values) { return rows_to_numpy<double>(values); }

py::array_t<double> to_numpy(const std::vector<Quaternion>& values) {
  py::array_t<double> array({std::ssize(values), py::ssize_t{4}});
  for (size_t i = 0; i < values.size(); ++i) put(values[i], array.mutable_data() + 4 * i);
  return array;
}

py::array_t<double> to_numpy(const std::vector<std::vector<Vec3>>& frames) {
  const size_t num_vertices = frames.empty() ? 0 : frames.front().size();
  py::array_t<double> array({std::ssize(frames), static_cast<py::ssize_t>(num_vertices), py::ssize_t{3}});
  double* out = array.mutable_data();
  for (const std::vector<Vec3>& frame : frames)
    for (const Vec3& vertex : frame) out = std::copy_n(vertex.data(), 3, out);
  return array;
}

py::array_t<uint32_t> to_numpy(const std::vector<IndexTriple>& values) { return rows_to_numpy<uint32_t>(values); }

py::array_t<int64_t> to_numpy(const std::vector<IndexPair>& values) { return rows_to_numpy<int64_t>(values); }

py::array_t<double> numpy_view(const std::vector<Vec3>& values, py::handle owner) {
  return numpy_view(values.empty() ? nullptr : values.data()->data(), {std::ssize(values), 3}, owner);
}

py::array_t<uint32_t> numpy_view(const std::vector<IndexTriple>& values, py::handle owner) {
  return numpy_view(values.empty() ? nullptr : values.data()->data(), {std::ssize(values), 3}, owner);
}

}  // namespace echopath::bindings
