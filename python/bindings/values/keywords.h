#pragma once
// Plain structs that Python makes by keywords and reads by attributes of the same names: one list of a struct's members says
// how both are called, what is taken and what help() says.
//
//   using LayerKeywords = ListOfKeywords<Layer, Keyword<"thickness", &Layer::thickness, Real, "m, across the layer">, ...>;
#include <pybind11/pybind11.h>

#include <vector>

#include "call/argument.h"
#include "call/define.h"
#include "values/travel.h"

namespace echopath::bindings {

namespace detail {

// How Python has the value of a member: as it is, a vector as an array, a list as a tuple, or an enum by its name.
template <class Kind>
struct PythonForm {
  template <class Value>
  static Value of(const Value& value) {
    return value;
  }
  static py::array_t<double> of(const Vec3& value) { return to_numpy(value); }
  template <class Item>
  static py::tuple of(const std::vector<Item>& values) {
    return py::tuple(py::cast(values));
  }
  // The same as a caller writes it.
  static auto written(const auto& value) { return of(value); }
  static py::tuple written(const Vec3& value) { return py::make_tuple(value.x(), value.y(), value.z()); }
  template <class Member>
  static auto field_of(const char* name, Member member) {
    return field(name, member);
  }
};
template <const auto& kChoice>
struct PythonForm<OneOf<kChoice>> {
  template <class Value>
  static const char* of(Value value) {
    return kChoice.name_of(value);
  }
  static const char* written(auto value) { return of(value); }
  template <class Member>
  static auto field_of(const char* name, Member member) {
    return field(name, member, kChoice);
  }
};

template <class Member>
struct StructOf;
template <class Struct, class Value>
struct StructOf<Value Struct::*> {
  using Type = Struct;
};

struct AnyMember {
  template <class Member>
  operator Member() const;
};

}  // namespace detail

// One member: its keyword, which may be left out for the value that a new struct has, its kind of argument.h, and what
// help() says of it.
template <Literal kKeyword, auto kMember, class Kind, Literal kDoc>
struct Keyword {
  using Argument = Arg<kKeyword, Kind>;
  using Struct = typename detail::StructOf<decltype(kMember)>::Type;
  using Form = detail::PythonForm<Kind>;
  static constexpr auto member = kMember;

  static constexpr const char* name() { return kKeyword.text; }
  static constexpr const char* doc() { return kDoc.text; }
  static auto value(const Struct& made) { return Form::of(made.*kMember); }
  static py::arg_v argument() { return py::arg(name()) = Form::written(Struct{}.*kMember); }
  static auto travelling() { return Form::field_of(name(), kMember); }
};

// The same where the keyword must be given.
template <Literal kKeyword, auto kMember, class Kind, Literal kDoc>
struct RequiredKeyword : Keyword<kKeyword, kMember, Kind, kDoc> {
  static py::arg argument() { return py::arg(kKeyword.text); }
};

template <class Struct, class... Keywords>
struct ListOfKeywords {
  static Struct made_of(const typename Keywords::Argument&... given) {
    Struct made;
    ((made.*Keywords::member = *given), ...);
    return made;
  }

  // Whether the list has a line for each member of the struct.
  static consteval bool is_whole() {
    constexpr bool fits = requires { Struct{(static_cast<void>(sizeof(Keywords)), detail::AnyMember{})...}; };
    constexpr bool fits_more =
        requires { Struct{detail::AnyMember{}, (static_cast<void>(sizeof(Keywords)), detail::AnyMember{})...}; };
    return fits && !fits_more;
  }
};

// Gives a class the read-only attributes of a list.
template <class Class, class Struct, class... Keywords>
void define_attributes(Class& type, ListOfKeywords<Struct, Keywords...>) {
  (type.def_property_readonly(
       Keywords::name(), [](const typename Class::type& self) { return Keywords::value(self); }, Keywords::doc()),
   ...);
}

// Gives a class a constructor that takes the keywords of a list, and the attributes. `check`, a lambda that captures
// nothing, raises where what they make is not allowed.
template <class Class, class Struct, class... Keywords, class Check>
void define_members(Class& type, ListOfKeywords<Struct, Keywords...> list, Check) {
  const auto make = [](const typename Keywords::Argument&... given) {
    Struct made = ListOfKeywords<Struct, Keywords...>::made_of(given...);
    Check{}(made);
    return made;
  };
  define_init(type, +make, py::kw_only(), Keywords::argument()...);
  define_attributes(type, list);
}

// The same where any values are allowed, with pickle, copy and == (travel.h).
template <class Class, class Struct, class... Keywords>
void define_record(Class& type, ListOfKeywords<Struct, Keywords...> list) {
  define_members(type, list, [](const Struct&) {});
  def_travel(type, Keywords::travelling()...);
}

}  // namespace echopath::bindings
