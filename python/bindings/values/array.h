#pragma once
// NumPy arrays <-> the vectors of the core. Each check names the argument, the shape and kind it must have and what came.
//
//   as_*         Python value -> core value, checked; TypeError for a wrong kind of value, ValueError for a wrong shape
//   to_numpy     core value -> new array
//   numpy_view   array over memory of the core, read-only and without a copy; it keeps `owner` alive
//   numpy_take   array that takes over a vector, without a copy
//
// Shapes are written as in the documentation: "[V, 3]" is any number of rows of three, "[]" a single number.
#include <pybind11/complex.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "echopath/base/geometry.h"

namespace echopath::bindings {

namespace py = pybind11;
using Shape = std::vector<py::ssize_t>;
using IndexTriple = std::array<uint32_t, 3>;
using IndexPair = std::array<int64_t, 2>;

// Of arrays whose memory is read as that of a vector: numbers of NumPy may stand at any address, as in the midst of a file.
constexpr int kAsVector = py::array::c_style | py::array::forcecast | py::detail::npy_api::NPY_ARRAY_ALIGNED_;

// `value` as a contiguous and aligned array of T with that shape. T: double takes real numbers, std::complex<double> real
// and complex ones, an integer type integers within its range, bool only bool. Lists and tuples of numbers will do.
template <class T>
py::array_t<T, py::array::c_style> checked_array(py::handle value, std::string_view argument, std::string_view shape);

// All numbers of an array, in C order.
template <class T, int kFlags>
std::vector<T> vector_of(const py::array_t<T, kFlags>& values) {
  return {values.data(), values.data() + values.size()};
}

Vec3 as_vec3(py::handle value, std::string_view argument);                              // [3], finite
std::vector<Vec3> as_points(py::handle value, std::string_view argument);               // [N, 3]
std::vector<std::vector<Vec3>> as_frames(py::handle value, std::string_view argument);  // [T, V, 3]
std::vector<IndexTriple> as_triangles(py::handle value, std::string_view argument);     // [F, 3], integers >= 0
std::vector<IndexPair> as_pairs(py::handle value, std::string_view argument);           // [N, 2], integers
Transform as_transform(py::handle value, std::string_view argument);                    // [4, 4], last row 0 0 0 1
Quaternion as_quaternion(py::handle value, std::string_view argument);                  // [4] (w, x, y, z), length 1
std::vector<Quaternion> as_quaternions(py::handle value, std::string_view argument);    // [N, 4]

// [N] by default; several dimensions are flattened in C order.
template <class T>
std::vector<T> as_vector(py::handle value, std::string_view argument, std::string_view shape = "[N]") {
  return vector_of(checked_array<T>(value, argument, shape));
}

py::array_t<double> to_numpy(const Vec3& value);                             // [3]
py::array_t<double> to_numpy(const Quaternion& value);                       // [4] (w, x, y, z)
py::array_t<double> to_numpy(const Transform& value);                        // [4, 4]
py::array_t<double> to_numpy(const std::vector<Vec3>& values);               // [N, 3]
py::array_t<double> to_numpy(const std::vector<Quaternion>& values);         // [N, 4]
py::array_t<double> to_numpy(const std::vector<std::vector<Vec3>>& frames);  // [T, V, 3], all frames of one size
py::array_t<uint32_t> to_numpy(const std::vector<IndexTriple>& values);      // [F, 3]
py::array_t<int64_t> to_numpy(const std::vector<IndexPair>& values);         // [N, 2]
template <class T>
py::array_t<T> to_numpy(const std::vector<T>& values) {  // [N]
  return py::array_t<T>(std::ssize(values), values.data());
}

// An owner for numpy_view: a Python object that keeps `pointer` alive.
template <class T>
py::capsule owner_of(std::shared_ptr<T> pointer) {
  using Holder = std::shared_ptr<T>;
  return py::capsule(new Holder(std::move(pointer)), [](void* holder) { delete static_cast<Holder*>(holder); });
}

template <class T>
py::array_t<T> numpy_view(const T* data, const Shape& shape, py::handle owner) {
  py::array_t<T> array(shape, data, owner);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}
template <class T>
py::array_t<T> numpy_view(const std::vector<T>& values, py::handle owner) {  // [N]
  return numpy_view(values.data(), {std::ssize(values)}, owner);
}
py::array_t<double> numpy_view(const std::vector<Vec3>& values, py::handle owner);           // [N, 3]
py::array_t<uint32_t> numpy_view(const std::vector<IndexTriple>& values, py::handle owner);  // [F, 3]

// Writable; `shape` must hold values.size() numbers.
template <class T>
py::array_t<T> numpy_take(std::vector<T>&& values, const Shape& shape) {
  auto kept = std::make_shared<std::vector<T>>(std::move(values));
  T* data = kept->data();
  return py::array_t<T>(shape, data, owner_of(std::move(kept)));
}
template <class T>
py::array_t<T> numpy_take(std::vector<T>&& values) {  // [N]
  const Shape shape{std::ssize(values)};
  return numpy_take(std::move(values), shape);
}

// Getters of attributes, of a member or a method of Class: a new array, or a view of memory in the object.
template <class Class, class Member>
auto array_of(Member Class::* member) {
  return [member](const Class& self) { return to_numpy(std::invoke(member, self)); };
}
template <class Class, class Member>
auto view_of(Member Class::* member) {
  return [member](const py::object& self) { return numpy_view(std::invoke(member, self.cast<const Class&>()), self); };
}
// The same of a vector that has several dimensions.
template <class Class, class Member>
auto view_of(Member Class::* member, Shape (*shape_of)(const Class& self)) {
  return [member, shape_of](const py::object& self) {
    const auto& owner = self.cast<const Class&>();
    return numpy_view((owner.*member).data(), shape_of(owner), self);
  };
}

namespace detail {

// `value` as an array whose dtype kind is one of `kinds` (NumPy's letters) and whose shape is `shape`, any dtype; otherwise
// raises, speaking of `what`.
py::array array_of_kind(py::handle value, std::string_view argument, std::string_view shape, std::string_view kinds,
                        std::string_view what);
// Raises ValueError unless all numbers of the integer array lie in [low, high].
void require_range(const py::array& array, std::string_view argument, int64_t low, uint64_t high);

}  // namespace detail

template <class T>
py::array_t<T, py::array::c_style> checked_array(py::handle value, std::string_view argument, std::string_view shape) {
  using Array = py::array_t<T, kAsVector>;
  py::array array;
  if constexpr (std::is_same_v<T, bool>) {
    array = detail::array_of_kind(value, argument, shape, "b", "bool");
  } else if constexpr (std::is_integral_v<T>) {
    array = detail::array_of_kind(value, argument, shape, "iu", "integers");
    detail::require_range(array, argument, static_cast<int64_t>(std::numeric_limits<T>::min()),
                          static_cast<uint64_t>(std::numeric_limits<T>::max()));
  } else if constexpr (std::is_floating_point_v<T>) {
    array = detail::array_of_kind(value, argument, shape, "iuf", "real numbers");
  } else {
    array = detail::array_of_kind(value, argument, shape, "iufc", "complex numbers");
  }
  return Array(std::move(array));
}

}  // namespace echopath::bindings
