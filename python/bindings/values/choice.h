#pragma once
// Enums that Python knows by name: the look-up, and the names of those that several binding files take.
#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "echopath/em/footprint_formula.h"
#include "echopath/em/polarization/jones.h"
#include "echopath/record/sampler.h"
#include "echopath/record/scatterers.h"
#include "echopath/replay/posed/specular_slide.h"
#include "echopath/signal/synthesizer.h"

namespace echopath::bindings {

// The names of an enum's values, in their order, and the argument by which errors call them.
template <class Enum, size_t N>
struct Choice {
  const char* argument;
  std::array<const char*, N> names;

  std::optional<Enum> find(std::string_view name) const {
    const auto found = std::ranges::find(names, name);
    return found == names.end() ? std::nullopt : std::optional<Enum>(static_cast<Enum>(found - names.begin()));
  }

  // Raises invalid_argument that lists the names.
  Enum value_of(std::string_view name) const {
    if (const auto found = find(name)) return *found;
    throw std::invalid_argument(std::string(argument) + ": must be " + listed() + ", got '" + std::string(name) + "'");
  }

  const char* name_of(Enum value) const { return names.at(static_cast<size_t>(value)); }

  // 'a', 'b' or 'c'
  std::string listed() const {
    std::string text;
    for (size_t i = 0; i < N; ++i) text += (i == 0 ? "'" : i + 1 == N ? " or '" : ", '") + std::string(names[i]) + "'";
    return text;
  }
};

template <class Enum, class... Names>
constexpr Choice<Enum, sizeof...(Names)> choice(const char* argument, Names... names) {
  return {argument, {names...}};
}

// A getter of the name of an enum, of a member or a method of Class.
template <class Enum, size_t N, class Class, class Member>
auto name_of(const Choice<Enum, N>& choice, Member Class::* member) {
  return [choice, member](const Class& self) { return choice.name_of(std::invoke(member, self)); };
}

inline constexpr auto kFootprint = choice<Footprint>("footprint", "none", "first_order", "second_order", "edges");
inline constexpr auto kMethod = choice<Method>("method", "auto", "direct", "recurrence", "nufft");
inline constexpr auto kPolarization = choice<PolarizationModel>("polarization", "scalar", "jones");
inline constexpr auto kSpecularPoints = choice<SpecularPoints>("replay", "material", "fermat");
inline constexpr auto kScatterers = choice<Scatterers>("scatterers", "rays", "surface");
inline constexpr auto kSampler = choice<Sampler>("sampler", "lattice", "fibonacci", "r2", "random");

}  // namespace echopath::bindings
