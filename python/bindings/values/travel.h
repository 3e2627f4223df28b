#pragma once
// Pickle, copy, deepcopy and == of plain results, told by a list of their fields, of which some are attributes, too:
//
//   def_travel(bound, attribute("range", &Map::range, "[range] m"), field("zero_pad", &Map::zero_pad))
//
// The state of a pickle is a dict of the fields by name, with vectors as NumPy arrays. Each is checked on the way in: a
// state that lacks a field, has others or holds what does not fit raises a ValueError or TypeError that names it.
#include <pybind11/complex.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <complex>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "echopath/base/errors.h"
#include "radar/window_name.h"
#include "values/array.h"

namespace echopath::bindings {

// How the value of a field becomes a Python object and back; `name` is that of the field, for messages.
template <class Value>
struct Codec {
  static py::object state(const Value& value) { return py::cast(value); }
  static Value value(py::handle state, const char* name) {
    try {
      return state.cast<Value>();
    } catch (const py::cast_error&) {
      throw py::type_error(std::string(name) + ": must be as a pickle has it, got a value of type " +
                           Py_TYPE(state.ptr())->tp_name);
    }
  }
};

template <>
struct Codec<Vec3> {
  static py::object state(const Vec3& value) { return to_numpy(value); }
  static Vec3 value(py::handle state, const char* name) { return as_vec3(state, name); }
};

template <>
struct Codec<std::vector<Vec3>> {
  static py::object state(const std::vector<Vec3>& values) { return to_numpy(values); }
  static std::vector<Vec3> value(py::handle state, const char* name) { return as_points(state, name); }
};

template <>
struct Codec<MapWindows> {
  static py::object state(const MapWindows& windows) { return map_windows_value(windows); }
  static MapWindows value(py::handle state, const char*) {
    return as_map_windows(py::reinterpret_borrow<py::object>(state));
  }
};

template <class Number>
  requires std::is_arithmetic_v<Number> || std::is_same_v<Number, std::complex<double>>
struct Codec<std::vector<Number>> {
  static py::object state(const std::vector<Number>& values) { return to_numpy(values); }
  static std::vector<Number> value(py::handle state, const char* name) { return as_vector<Number>(state, name); }
};

template <>
struct Codec<std::vector<IndexPair>> {
  static py::object state(const std::vector<IndexPair>& pairs) { return to_numpy(pairs); }
  static std::vector<IndexPair> value(py::handle state, const char* name) { return as_pairs(state, name); }
};

// Whether two values are the same; unlike ==, NaN is the same as NaN.
template <class Value>
bool is_same(const Value& a, const Value& b) {
  if constexpr (std::is_floating_point_v<Value>) {
    return a == b || (a != a && b != b);
  } else if constexpr (std::is_same_v<Value, std::complex<double>>) {
    return is_same(a.real(), b.real()) && is_same(a.imag(), b.imag());
  } else if constexpr (requires {
                         typename Value::value_type;
                         a.begin();
                       }) {
    using Item = typename Value::value_type;
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Item& x, const Item& y) { return is_same(x, y); });
  } else if constexpr (requires { a == b; }) {
    return a == b;
  } else {
    return py::cast(a).equal(py::cast(b));
  }
}

// A field: its name, and a pointer to the member or a function that gives a reference to it.
template <class Access>
struct Field {
  const char* name;
  Access access;

  template <class Type>
  using ValueOf = std::remove_cvref_t<std::invoke_result_t<const Access&, Type&>>;

  template <class Type>
  void save(const Type& from, py::dict& state) const {
    state[name] = Codec<ValueOf<const Type>>::state(std::invoke(access, from));
  }
  template <class Type>
  void load(Type& into, const py::dict& state) const {
    std::invoke(access, into) = Codec<ValueOf<Type>>::value(state[name], name);
  }
  template <class Type>
  bool same(const Type& a, const Type& b) const {
    return is_same(std::invoke(access, a), std::invoke(access, b));
  }
};

template <class Access>
Field<Access> field(const char* name, Access access) {
  return {name, std::move(access)};
}

// A field that is a read-only attribute of the same name, as pybind11 shows it: a vector as a list.
template <class Member>
struct Attribute : Field<Member> {
  const char* doc;

  void show(auto& bound) const { bound.def_readonly(this->name, this->access, doc); }
};

template <class Member>
Attribute<Member> attribute(const char* name, Member member, const char* doc) {
  return {{name, member}, doc};
}

// The same of a vector that is shown as a view (array.h).
template <class Access>
struct ArrayAttribute : Field<Access> {
  const char* doc;

  template <class Type, class... Options>
  void show(py::class_<Type, Options...>& bound) const {
    const auto view = [access = this->access](const py::object& self) {
      return numpy_view(std::invoke(access, self.cast<const Type&>()), self);
    };
    bound.def_property_readonly(this->name, view, doc);
  }
};

template <class Access>
ArrayAttribute<Access> array_attribute(const char* name, Access access, const char* doc) {
  return {{name, std::move(access)}, doc};
}

// A field that is an enum, by its name; `names` is a Choice (choice.h).
template <class Access, class Names>
struct NamedField {
  const char* name;
  Access access;
  Names names;

  template <class Type>
  void save(const Type& from, py::dict& state) const {
    state[name] = py::str(names.name_of(std::invoke(access, from)));
  }
  template <class Type>
  void load(Type& into, const py::dict& state) const {
    std::invoke(access, into) = names.value_of(Codec<std::string>::value(state[name], name));
  }
  template <class Type>
  bool same(const Type& a, const Type& b) const {
    return std::invoke(access, a) == std::invoke(access, b);
  }
};

template <class Access, class Names>
NamedField<Access, Names> field(const char* name, Access access, Names names) {
  return {name, std::move(access), std::move(names)};
}

// Raises ValueError unless `values` has as many as fit the shape.
template <class Value>
void require_shape(const std::vector<Value>& values, const Shape& shape, const char* name) {
  py::ssize_t count = 1;
  for (const py::ssize_t size : shape) count *= size;
  require(std::ssize(values) == count, name, "must have " + std::to_string(count) + " values, as the other fields have it",
          values.size());
}

// Raises ValueError unless the state of a pickle has these fields and no others.
void require_fields(const py::dict& state, const std::vector<std::string>& names);

// Gives a class pickle, copy and ==, and its attributes. `check` raises where fields do not fit each other.
template <class Type, class... Options, class Check, class... Fields>
void def_travel_checked(py::class_<Type, Options...>& bound, Check check, Fields... fields) {
  const auto show = [&bound](const auto& each) {
    if constexpr (requires { each.show(bound); }) each.show(bound);
  };
  (show(fields), ...);
  bound.def("__eq__", [fields...](const Type& a, const Type& b) { return (fields.same(a, b) && ...); }, py::is_operator());
  bound.def(py::pickle(
      [fields...](const Type& self) {
        py::dict state;
        (fields.save(self, state), ...);
        return state;
      },
      [check, fields...](const py::dict& state) {
        require_fields(state, {fields.name...});
        Type made;
        (fields.load(made, state), ...);
        check(made);
        return made;
      }));
}

// The same where any values of the fields fit each other.
template <class Type, class... Options, class... Fields>
void def_travel(py::class_<Type, Options...>& bound, Fields... fields) {
  def_travel_checked(bound, [](const Type&) {}, std::move(fields)...);
}

}  // namespace echopath::bindings
