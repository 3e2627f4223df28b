// Curves of animation files, and what they move: rigid and other motions, and morph targets.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <sstream>
#include <string>

#include "call/argument.h"
#include "call/define.h"
#include "call/leaving.h"
#include "echopath/base/errors.h"
#include "echopath/base/text/streamed.h"
#include "echopath/motion/curve_motion.h"
#include "echopath/motion/morph_targets.h"
#include "scene/deformation_type.h"
#include "scene/playback.h"
#include "values/value.h"

namespace echopath::bindings {
namespace {

constexpr auto kCurveInterpolation = choice<CurveInterpolation>("interpolation", "step", "linear", "hermite");
using CurveArgument = Optional<Instance<Curve>>;
using Rows = Array<double, "[T, C]">;

Curve curve(Arg<"times", VectorOf<double>> times, Arg<"values", Rows> values,
            Arg<"interpolation", OneOf<kCurveInterpolation>> interpolation, Arg<"in_tangents", Optional<Rows>> in_tangents,
            Arg<"out_tangents", Optional<Rows>> out_tangents) {
  Curve made{*times, vector_of(*values), *interpolation, {}, {}};
  require(values->shape(1) >= 1, "values", "must have at least one column", values->shape(1));
  const bool is_hermite = *interpolation == CurveInterpolation::kHermite;
  const auto check = [&](const std::optional<Rows::Value>& given, const char* name) {
    require(given.has_value() == is_hermite, name, "must be given for 'hermite' and for nothing else",
            kCurveInterpolation.name_of(*interpolation));
  };
  check(*in_tangents, "in_tangents");
  check(*out_tangents, "out_tangents");
  if (is_hermite) made.in_tangents = vector_of(**in_tangents), made.out_tangents = vector_of(**out_tangents);
  made.validate_times("times");
  made.validate("values", static_cast<size_t>(values->shape(1)));
  return made;
}

py::array_t<double> rows_of(const Curve& self, std::vector<double> numbers) {
  const auto rows = std::ssize(self.times);
  return numpy_take(std::move(numbers), {rows, static_cast<py::ssize_t>(self.num_columns())});
}

py::object tangents_of(const Curve& self, const std::vector<double>& numbers) {
  return numbers.empty() ? py::object(py::none()) : py::object(rows_of(self, numbers));
}

std::shared_ptr<CurveMotion> curve_motion(Arg<"translation", CurveArgument> translation,
                                          Arg<"rotation", CurveArgument> rotation, Arg<"scale", CurveArgument> scale,
                                          Arg<"period", Optional<Real>> period, Arg<"offset", Real> offset) {
  return std::make_shared<CurveMotion>(MotionCurves{*translation, *rotation, *scale}, playback_of(*period, *offset));
}

std::shared_ptr<MorphTargets> morph_targets(Arg<"vertices", Points> vertices, Arg<"targets", Frames> targets,
                                            Arg<"weights", Instance<Curve>> weights, Arg<"period", Optional<Real>> period,
                                            Arg<"offset", Real> offset) {
  const Playback playback = playback_of(*period, *offset);
  const WithoutGil released;
  return std::make_shared<MorphTargets>(*vertices, *targets, *weights, playback);
}

py::array_t<double> value_at(const Curve& self, Arg<"time", Real> time) {
  std::vector<double> row(self.num_columns());
  evaluate(self, {}, *time, row);
  return numpy_take(std::move(row));
}

void bind_curve(py::module_& m) {
  py::class_<Curve> type(m, "Curve", R"(Numbers through keys, as animation files have them (glTF 2.0, appendix C).

times: [T] in s, ascending, T >= 1
values: [T, C], in the unit of what they stand for
interpolation: "step" (the earlier key holds until the next), "linear", or "hermite" (cubic splines with given tangents)
in_tangents, out_tangents: [T, C] per s, before and behind each key; for "hermite" alone
Before its first key and after its last one it holds their values. Raises TypeError or ValueError naming the argument.)");
  define_init(type, &curve, py::arg("times"), py::arg("values"), py::arg("interpolation") = "linear", py::kw_only(),
              py::arg("in_tangents") = py::none(), py::arg("out_tangents") = py::none())
      .def_property_readonly("times", array_of(&Curve::times), "[T] in s")
      .def_property_readonly(
          "values", [](const Curve& self) { return rows_of(self, self.values); }, "[T, C]")
      .def_property_readonly("interpolation", name_of(kCurveInterpolation, &Curve::interpolation),
                             "\"step\", \"linear\" or \"hermite\"")
      .def_property_readonly(
          "in_tangents", [](const Curve& self) { return tangents_of(self, self.in_tangents); }, "[T, C] per s, or None")
      .def_property_readonly(
          "out_tangents", [](const Curve& self) { return tangents_of(self, self.out_tangents); }, "[T, C] per s, or None")
      .def("__repr__", [](const Curve& self) {
        return streamed("Curve(", counted(self.times.size(), "key"), ", ", self.times.front(), " to ", self.times.back(),
                        " s, ", counted(self.num_columns(), "column"), ", ", kCurveInterpolation.name_of(self.interpolation),
                        ")");
      });
  define(type, "at", &value_at, py::arg("time"), "Values [C] at `time` in s, column by column. Raises ValueError.");
  define_value(type);
  define_replace(type);
}

template <class Moving, class... Options>
void add_playback(py::class_<Moving, Options...>& type) {
  type.def_property_readonly(
          "period", [](const Moving& self) { return period_of(self.playback()); }, "s, or None where it is no loop")
      .def_property_readonly(
          "offset", [](const Moving& self) { return self.playback().offset; }, "s, time of its curves at time 0");
}

void bind_curve_motion(py::module_& m) {
  py::class_<CurveMotion, Motion, std::shared_ptr<CurveMotion>> type(m, "CurveMotion", R"(Motion of curves: an animation.

translation: Curve of [T, 3] in m; rotation: Curve of [T, 4] quaternions (w, x, y, z), which go the shorter way between linear
    keys; scale: Curve of [T, 3], for joints of a Skin alone. None: none
period: s; it begins anew after this time. None: it is played once, held before and after
offset: s, the time of the curves at time 0
It is defined at every time; each key, and each end of a loop, is a breakpoint. Raises TypeError or ValueError naming the
argument.)");
  define_init(type, &curve_motion, py::arg("translation") = py::none(), py::arg("rotation") = py::none(),
              py::arg("scale") = py::none(), py::kw_only(), py::arg("period") = py::none(), py::arg("offset") = 0.0)
      .def_property_readonly(
          "translation", [](const CurveMotion& self) { return self.curves().translation; }, "Curve of [T, 3] in m, or None")
      .def_property_readonly(
          "rotation", [](const CurveMotion& self) { return self.curves().rotation; },
          "Curve of [T, 4] (w, x, y, z), or None")
      .def_property_readonly(
          "scale", [](const CurveMotion& self) { return self.curves().scale; }, "Curve of [T, 3], or None")
      .def("__repr__", [](const CurveMotion& self) {
        std::ostringstream text;
        const MotionCurves& curves = self.curves();
        text << "CurveMotion(" << (curves.translation ? "translation, " : "") << (curves.rotation ? "rotation, " : "")
             << (curves.scale ? "scale, " : "");
        if (self.playback().period > 0.0) text << "every " << self.playback().period << " s, ";
        text << "offset " << self.playback().offset << " s)";
        return text.str();
      });
  add_playback(type);
  define_value(type);
  define_replace(type);
}

void bind_morph_targets(py::module_& m) {
  py::class_<MorphTargets, Deformation, std::shared_ptr<MorphTargets>> type(m, "MorphTargets",
                                                                            R"(Deforming mesh: shares of other shapes.

v(t) = vertices + sum over targets of weight(t) * target, exact at every time.
vertices: [V, 3] in m, in the node's frame and in the order of the vertices the mesh was made from
targets: [K, V, 3] in m, displacements
weights: Curve of [T, K]
period, offset: s, as of a CurveMotion
A Skin moves its result with `Skin(..., shape=...)`. Raises TypeError or ValueError naming the argument.)");
  define_init(type, &morph_targets, py::arg("vertices"), py::arg("targets"), py::arg("weights"), py::kw_only(),
              py::arg("period") = py::none(), py::arg("offset") = 0.0)
      .def_property_readonly("vertices", array_of(&MorphTargets::vertices), "[V, 3] in m")
      .def_property_readonly("targets", array_of(&MorphTargets::targets), "[K, V, 3] in m, a copy")
      .def_property_readonly(
          "weights", [](const MorphTargets& self) { return self.weights(); }, "Curve of [T, K]")
      .def("__repr__", [](const MorphTargets& self) {
        return "MorphTargets(" + std::to_string(self.num_vertices()) + " vertices, " +
               counted(self.targets().size(), "target") + ")";
      });
  add_playback(type);
  define_value(type);
  define_replace(type);
}

}  // namespace

void bind_curves(py::module_& m) {
  bind_curve(m);
  bind_curve_motion(m);
  bind_morph_targets(m);
}

}  // namespace echopath::bindings
