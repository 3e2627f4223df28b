#pragma once
// The settings of a record (RecordSettings) as Python knows them: the one list of what `trace`, `LiveTrace.update` and
// `TraceFrame` take by keyword.
#include <pybind11/pybind11.h>

#include <type_traits>

#include "call/argument.h"
#include "echopath/record/paths.h"
#include "values/choice.h"
#include "values/travel.h"

namespace echopath::bindings {

namespace detail {

// How Python has the value of a member: as it is, or an enum by its name.
template <class Kind>
struct PythonForm {
  template <class Value>
  static Value of(Value value) {
    return value;
  }
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
  template <class Member>
  static auto field_of(const char* name, Member member) {
    return field(name, member, kChoice);
  }
};

}  // namespace detail

// One setting: its keyword, its member of RecordSettings, its kind of argument.h, and what help() says of it.
template <Literal kKeyword, auto kMember, class Kind, Literal kDoc>
struct RecordKeyword {
  using Argument = Arg<kKeyword, Kind>;
  using Form = detail::PythonForm<Kind>;
  static constexpr auto member = kMember;

  static constexpr const char* name() { return kKeyword.text; }
  static constexpr const char* doc() { return kDoc.text; }
  static auto value(const RecordSettings& settings) { return Form::of(settings.*kMember); }
  static py::arg_v argument() { return py::arg(name()) = value(RecordSettings{}); }
  static auto travelling() { return Form::field_of(name(), kMember); }
};

template <class... Keywords>
struct ListOfKeywords {
  static RecordSettings settings_of(const typename Keywords::Argument&... given) {
    RecordSettings settings;
    ((settings.*Keywords::member = *given), ...);
    return settings;
  }
};

using RecordKeywords = ListOfKeywords<
    RecordKeyword<"seed", &RecordSettings::seed, Seed, "of directions and random phases">,
    RecordKeyword<"max_bounces", &RecordSettings::max_bounces, Count, "hits of a path at most">,
    RecordKeyword<"polarization", &RecordSettings::polarization, OneOf<kPolarization>, "\"scalar\" or \"jones\"">,
    RecordKeyword<"footprint", &RecordSettings::footprint, OneOf<kFootprint>,
                  "\"second_order\", \"edges\", \"first_order\" or \"none\"">,
    RecordKeyword<"sampler", &RecordSettings::sampler, OneOf<kSampler>, "\"lattice\", \"fibonacci\", \"r2\" or \"random\"">,
    RecordKeyword<"num_batches", &RecordSettings::batches, Count, "independent parts of the rays">,
    RecordKeyword<"scatterers", &RecordSettings::scatterers, OneOf<kScatterers>,
                  "\"rays\" or \"surface\": what the scatterers of rough surfaces are">,
    RecordKeyword<"edges", &RecordSettings::edges, Flag, "whether echoes of sharp edges were looked for">,
    RecordKeyword<"attenuation", &RecordSettings::attenuation, Real, "Np/m of fields in the air, along every path">,
    RecordKeyword<"faint_power", &RecordSettings::faint_power, Real,
                  "W, below which some of the diffuse paths were kept for all of them; 0: all were">>;

namespace detail {

struct AnyMember {
  template <class Member>
  operator Member() const;
};

template <class... Keywords>
consteval bool has_all_members(ListOfKeywords<Keywords...>) {
  constexpr bool fits = requires { RecordSettings{(static_cast<void>(sizeof(Keywords)), AnyMember{})...}; };
  constexpr bool fits_more =
      requires { RecordSettings{AnyMember{}, (static_cast<void>(sizeof(Keywords)), AnyMember{})...}; };
  return fits && !fits_more;
}
static_assert(has_all_members(RecordKeywords{}), "each member of RecordSettings needs its line in RecordKeywords");

}  // namespace detail

}  // namespace echopath::bindings
