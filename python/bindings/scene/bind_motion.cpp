#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/typing.h>

#include <limits>
#include <memory>
#include <string>

#include "call/argument.h"
#include "call/define.h"
#include "call/leaving.h"
#include "call/plausible.h"
#include "echopath/base/errors.h"
#include "echopath/base/text/streamed.h"
#include "echopath/motion/looped_sequence.h"
#include "scene/deformation_type.h"
#include "scene/playback.h"
#include "values/value.h"

namespace echopath::bindings {
namespace {

constexpr auto kInterpolation = choice<Interpolation>("interpolation", "cubic", "linear", "monotone");

py::typing::Tuple<double, double> as_tuple(const TimeSpan& span) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const TimeSpan whole;
  return py::make_tuple(span.begin <= whole.begin ? -kInfinity : span.begin, span.end >= whole.end ? kInfinity : span.end);
}

std::string description(const char* kind, const TimeSpan& span, size_t num_times, Interpolation interpolation) {
  return streamed(kind, "(", num_times, " times, ", span.begin, " to ", span.end, " s, ",
                  kInterpolation.name_of(interpolation), ")");
}

std::shared_ptr<LinearMotion> linear_motion(Arg<"velocity", Vector3> velocity,
                                            Arg<"angular_velocity", Vector3> angular_velocity) {
  require_below_light(velocity->norm(), "velocity");
  return std::make_shared<LinearMotion>(*velocity, *angular_velocity);
}

std::shared_ptr<KeyframeMotion> keyframe_motion(Arg<"times", VectorOf<double>> times,
                                                Arg<"translations", Optional<Points>> translations,
                                                Arg<"rotations", Optional<UnitQuaternions>> rotations,
                                                Arg<"interpolation", OneOf<kInterpolation>> interpolation) {
  const auto made = std::make_shared<KeyframeMotion>(*times, translations->value_or(std::vector<Vec3>{}),
                                                     rotations->value_or(std::vector<Quaternion>{}), *interpolation);
  for (size_t i = 1; i < made->translations().size(); ++i) {
    const double way = (made->translations()[i] - made->translations()[i - 1]).norm();
    require_below_light(way / (made->times()[i] - made->times()[i - 1]), "translations");
  }
  return made;
}

std::shared_ptr<VertexSequence> vertex_sequence(Arg<"times", VectorOf<double>> times, Arg<"vertices", Frames> vertices,
                                                Arg<"interpolation", OneOf<kInterpolation>> interpolation,
                                                Arg<"period", Optional<Real>> period, Arg<"offset", Real> offset) {
  const Playback playback = playback_of(*period, *offset);
  require(*period || playback.offset == 0.0, "offset", "must be 0 s without a period", playback.offset);
  const WithoutGil released;
  if (*period) return std::make_shared<LoopedSequence>(*times, *vertices, *interpolation, playback);
  return std::make_shared<VertexSequence>(*times, *vertices, *interpolation);
}

Playback loop_of(const VertexSequence& self) {
  const auto* looped = dynamic_cast<const LoopedSequence*>(&self);
  return looped ? looped->playback() : Playback{};
}

constexpr const char* kTurnRateDoc = R"(Bound in rad/s of how fast what it does comes and goes between `begin` and `end` (s).

That of its angular speed or, where it goes to and fro between samples, pi by the shortest time from one turning point to the
next: the larger. 0: it goes straight on. Raises TypeError or ValueError naming the argument.)";

template <class Moving>
double turn_rate_of(const Moving& self, Arg<"begin", Real> begin, Arg<"end", Real> end) {
  return self.turn_rate({*begin, *end});
}

template <class Moving>
py::array_t<double> at(const Moving& self, Arg<"time", Real> time) {
  return to_numpy(self.at(*time));
}

// What motions and deformations have in common; at_doc: of their values at a time.
template <class Timed>
void define_in_time(py::class_<Timed, std::shared_ptr<Timed>>& type, const char* at_doc) {
  define(type, "at", &at<Timed>, py::arg("time"), at_doc);
  define(type, "turn_rate", &turn_rate_of<Timed>, py::arg("begin"), py::arg("end"), kTurnRateDoc);
  type.def_property_readonly(
          "breakpoints", [](const Timed& self) { return to_numpy(self.breakpoints()); },
          "Times [N] in s, ascending, where it is not smooth; of a loop those of one run.")
      .def_property_readonly(
          "span", [](const Timed& self) { return as_tuple(self.span()); },
          "(begin, end) in s of the times it is defined on; infinite where unlimited.");
}

void bind_motions(py::module_& m) {
  py::class_<Motion, std::shared_ptr<Motion>> type(
      m, "Motion", "Time -> rigid transform, in the axes of the node's parent about the node's own origin.");
  define_no_init(type, "LinearMotion, KeyframeMotion and CurveMotion");
  define_in_time(type, "Transform [4, 4] (translation in m) at `time` in s. Raises ValueError outside `span`.");
}

void bind_linear(py::module_& m) {
  py::class_<LinearMotion, Motion, std::shared_ptr<LinearMotion>> type(m, "LinearMotion", R"(Constant velocity and rotation.

velocity: [3] in m/s
angular_velocity: [3] in rad/s, right-handed about its own direction
Raises TypeError or ValueError naming the argument.)");
  define_init(type, &linear_motion, py::arg("velocity") = py::make_tuple(0.0, 0.0, 0.0),
              py::arg("angular_velocity") = py::make_tuple(0.0, 0.0, 0.0))
      .def_property_readonly("velocity", array_of(&LinearMotion::velocity), "[3] in m/s")
      .def_property_readonly("angular_velocity", array_of(&LinearMotion::angular_velocity), "[3] in rad/s")
      .def("__repr__", [](const LinearMotion& self) {
        const Vec3 &v = self.velocity(), &w = self.angular_velocity();
        return streamed("LinearMotion(velocity=(", v.x(), ", ", v.y(), ", ", v.z(), ") m/s, angular_velocity=(", w.x(), ", ",
                        w.y(), ", ", w.z(), ") rad/s)");
      });
  define_value(type);
  define_replace(type);
}

void bind_keyframes(py::module_& m) {
  py::class_<KeyframeMotion, Motion, std::shared_ptr<KeyframeMotion>> type(m, "KeyframeMotion", R"(Motion through keys.

times: [T] in s, ascending, T >= 2
translations: [T, 3] in m, or None for none
rotations: [T, 4] unit quaternions (w, x, y, z), or None for none
interpolation: "cubic" (C2 splines, smooth everywhere, which swing past what stops or starts at once), "monotone" (C1 cubics
    after Fritsch and Butland, which rest between equal keys and do not pass those on a line; their acceleration jumps) or
    "linear" (and slerp; the velocity jumps). Of the latter two each inner time is a breakpoint
Between two keys a rotation goes the shorter way. Raises TypeError or ValueError naming the argument.)");
  define_init(type, &keyframe_motion, py::arg("times"), py::arg("translations") = py::none(),
              py::arg("rotations") = py::none(), py::arg("interpolation") = "cubic")
      .def_property_readonly("times", array_of(&KeyframeMotion::times), "[T] in s")
      .def_property_readonly("translations", array_of(&KeyframeMotion::translations),
                             "[T, 3] in m, [0, 3] where none were given")
      .def_property_readonly("rotations", array_of(&KeyframeMotion::rotations),
                             "[T, 4] (w, x, y, z), neighbours in one half space; [0, 4] where none were given")
      .def_property_readonly("interpolation", name_of(kInterpolation, &KeyframeMotion::interpolation),
                             "\"cubic\", \"linear\" or \"monotone\"")
      .def("__repr__", [](const KeyframeMotion& self) {
        return description("KeyframeMotion", self.span(), self.times().size(), self.interpolation());
      });
  define_value(type);
  define_replace(type);
}

void bind_deformation(py::module_& m) {
  py::class_<Deformation, std::shared_ptr<Deformation>> type(
      m, "Deformation", "Time -> vertices, which replace those of a mesh, in the node's own frame.");
  define_no_init(type, "VertexSequence, Skin and MorphTargets");
  define_in_time(type, "Vertices [V, 3] in m at `time` in s. Raises ValueError outside `span`.");
  type.def_property_readonly("num_vertices", &Deformation::num_vertices, "V, of each instant");
}

void bind_sequence(py::module_& m) {
  py::class_<VertexSequence, Deformation, std::shared_ptr<VertexSequence>> type(m, "VertexSequence",
                                                                                R"(Deforming mesh: time -> vertices.

times: [T] in s, ascending, T >= 2
vertices: [T, V, 3] in m, in the node's frame and in the order of the vertices the mesh was made from
interpolation: "cubic" (C2 splines, which swing past what stops or starts at once), "monotone" or "linear" (each inner time
    is a breakpoint), as of KeyframeMotion
period: s; what the sequence does from 0 s to this time, which `times` must hold, is repeated without end. Frames before and
    behind shape the splines: a loop whose outer frames repeat its inner ones goes on smoothly. None: it is defined on `span`
offset: s, the time of a loop at time 0
Raises TypeError or ValueError naming the argument. All but linear sequences take twice the memory of their vertices.)");
  define_init(type, &vertex_sequence, py::arg("times"), py::arg("vertices"), py::arg("interpolation") = "cubic",
              py::kw_only(), py::arg("period") = py::none(), py::arg("offset") = 0.0)
      .def_property_readonly("times", array_of(&VertexSequence::times), "[T] in s")
      .def_property_readonly("vertices", array_of(&VertexSequence::vertices), "[T, V, 3] in m, a copy")
      .def_property_readonly("interpolation", name_of(kInterpolation, &VertexSequence::interpolation),
                             "\"cubic\", \"linear\" or \"monotone\"")
      .def_property_readonly(
          "period", [](const VertexSequence& self) { return period_of(loop_of(self)); }, "s, or None where it is no loop")
      .def_property_readonly(
          "offset", [](const VertexSequence& self) { return loop_of(self).offset; }, "s, time of the loop at time 0")
      .def("__repr__", [](const VertexSequence& self) {
        const std::string kind = "VertexSequence(" + std::to_string(self.num_vertices()) + " vertices, ";
        return kind + description("", self.span(), self.times().size(), self.interpolation()).substr(1);
      });
  define_value(type);
  define_replace(type);
}

}  // namespace

void bind_motion(py::module_& m) {
  bind_motions(m);
  bind_linear(m);
  bind_keyframes(m);
  bind_deformation(m);
  bind_sequence(m);
}

}  // namespace echopath::bindings
