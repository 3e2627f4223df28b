#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <optional>
#include <string>

#include "call/argument.h"
#include "call/define.h"
#include "call/plausible.h"
#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/geometry.h"
#include "echopath/base/range_of_coordinates.h"
#include "echopath/base/text/streamed.h"
#include "echopath/radar/radar.h"
#include "radar/place_text.h"
#include "values/array.h"
#include "values/value.h"

namespace echopath::bindings {
namespace {

// A vector of unit length up to `kUnitTolerance` is scaled to it; one that already is keeps its bits.
constexpr double kNormRounding = 1e-14;
constexpr double kLevel = 1e-9;  // rad, of antennas whose +y is level

template <class Vector>
void make_unit(Vector& vector, const char* argument) {
  const double norm = vector.norm();
  require(std::abs(norm - 1.0) <= kUnitTolerance, argument, "must have norm 1 within 1e-6", norm);
  if (std::abs(norm - 1.0) > kNormRounding) vector /= norm;
}

// Yaw and pitch as of `turned`, and roll, a turn about +x before them, in rad: the rotation is turned(yaw, pitch) R_x(roll).
struct Attitude {
  double yaw, pitch, roll;
};

Attitude attitude_of(const Quaternion& rotation) {
  constexpr double kUpright = 1e-8;  // of +x across z: yaw and roll are one turn, which counts as yaw
  const Mat3 axes = rotation.toRotationMatrix();
  const double across = std::hypot(axes(0, 0), axes(1, 0)), pitch = std::atan2(axes(2, 0), across);
  if (across < kUpright) return {std::atan2(-axes(0, 1), axes(1, 1)), pitch, 0.0};
  return {std::atan2(axes(1, 0), axes(0, 0)), pitch, std::atan2(axes(2, 1), axes(2, 2))};
}

Quaternion orientation_of(const std::optional<Quaternion>& orientation, double yaw, double pitch) {
  require(std::abs(pitch) <= 0.5 * kPi, "pitch", "must be from -pi/2 to pi/2 rad", pitch);
  if (!orientation) return turned(yaw, pitch);
  require(yaw == 0.0, "yaw", "must not be given together with orientation", yaw);
  require(pitch == 0.0, "pitch", "must not be given together with orientation", pitch);
  return *orientation;
}

Antenna antenna(const Arg<"position", Vector3>& position, const Arg<"yaw", Real>& yaw, const Arg<"pitch", Real>& pitch,
                const Arg<"orientation", Optional<UnitQuaternion>>& orientation,
                const Arg<"pattern", Optional<Instance<AntennaPattern>>>& pattern,
                const Arg<"polarization", Vector3>& polarization) {
  Antenna made;
  made.position = *position;
  require_in_range(made.position, "position", "the antenna");
  made.orientation = orientation_of(*orientation, *yaw, *pitch);
  made.polarization = *polarization;
  made.pattern = pattern->value_or(AntennaPattern{});
  make_unit(made.orientation.coeffs(), "orientation");
  make_unit(made.polarization, "polarization");
  warn_of_turns(*yaw);
  return made;
}

py::dict keywords_of_antenna(const py::object& object) {
  const auto& self = object.cast<const Antenna&>();
  const Quaternion& q = self.orientation;
  return py::dict(py::arg("position") = tuple_of(self.position),
                  py::arg("orientation") = py::make_tuple(q.w(), q.x(), q.y(), q.z()), py::arg("pattern") = self.pattern,
                  py::arg("polarization") = tuple_of(self.polarization));
}

py::object replace_in_antenna(const py::object& self, const py::kwargs& changes) {
  const py::dict keywords = keywords_of_antenna(self);
  if (!changes.contains("yaw") && !changes.contains("pitch"))
    return detail::remade(py::type::of<Antenna>(), keywords, changes);
  const auto [yaw, pitch, roll] = attitude_of(self.cast<const Antenna&>().orientation);
  require(std::abs(roll) < kLevel, changes.contains("yaw") ? "yaw" : "pitch",
          "must be replaced by an orientation where the antenna is rolled about its boresight, by rad", roll);
  keywords.attr("pop")("orientation");
  keywords["yaw"] = yaw, keywords["pitch"] = pitch;
  return detail::remade(py::type::of<Antenna>(), keywords, changes);
}

std::string text_of(const Antenna& a) {
  const auto [yaw, pitch, roll] = attitude_of(a.orientation);
  return streamed("Antenna(", place_text(a.position, yaw, pitch), std::abs(roll) < kLevel ? "" : ", rolled",
                  ", pattern=", part_text(a.pattern), ")");
}

}  // namespace

void bind_antennas(py::module_& m) {
  py::class_<Antenna> type(m, "Antenna", R"(One element of a radar.

position: [3] m, in the radar's frame
yaw: rad about the radar's z, left positive, as in scene.add: where the boresight points, +x of the antenna's frame
pitch: rad, -pi/2 to pi/2, up positive: then about the antenna's own +y, which stays level
orientation: [4] unit quaternion (w, x, y, z), radar from antenna, instead of yaw and pitch, for antennas that are rolled, too
pattern: Isotropic(gain), CosinePower(exponent, peak_gain), GaussianBeam(...), GainTable(...) or load_antenna(path); None is
    Isotropic(1)
polarization: [3] unit vector in the antenna's frame
Antennas of equal arguments are equal, and pickle.
Raises ValueError or TypeError naming the argument. Warns (RuntimeWarning) of a yaw beyond a turn, which looks like degrees.)");
  define_init(type, &antenna, py::arg("position") = py::make_tuple(0.0, 0.0, 0.0), py::kw_only(), py::arg("yaw") = 0.0,
              py::arg("pitch") = 0.0, py::arg("orientation") = py::none(), py::arg("pattern") = py::none(),
              py::arg("polarization") = py::make_tuple(0.0, 0.0, 1.0));
  type.def_property_readonly("position", array_of(&Antenna::position), "[3] m, in the radar's frame")
      .def_property_readonly(
          "yaw", [](const Antenna& self) { return attitude_of(self.orientation).yaw; },
          "rad, of the boresight in the radar's frame, left positive")
      .def_property_readonly(
          "pitch", [](const Antenna& self) { return attitude_of(self.orientation).pitch; },
          "rad, of the boresight in the radar's frame, up positive")
      .def_property_readonly("orientation", array_of(&Antenna::orientation), "[4] (w, x, y, z), radar from antenna")
      .def_readonly("pattern", &Antenna::pattern, "AntennaPattern")
      .def_property_readonly("polarization", array_of(&Antenna::polarization), "[3], unit, in the antenna's frame")
      .def("__repr__", [](const Antenna& self) { return text_of(self); });
  define_value(type, &keywords_of_antenna);
  define_no_change(type);
  define(type, "replace", &replace_in_antenna, R"(A copy with some arguments of the constructor changed.

changes: keywords of Antenna; yaw or pitch alone keep the other one
Returns an Antenna. Raises what Antenna raises, and ValueError for yaw and pitch of an antenna that is rolled.)");
}

}  // namespace echopath::bindings
