#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "call/argument.h"
#include "call/define.h"
#include "call/plausible.h"
#include "echopath/base/errors.h"
#include "echopath/base/text/streamed.h"
#include "echopath/radar/radar.h"
#include "radar/place_text.h"
#include "values/array.h"
#include "values/choice.h"
#include "values/held_object.h"
#include "values/in_package.h"
#include "values/shared.h"
#include "values/value.h"

namespace echopath::bindings {
namespace {

constexpr auto kMultiplexing = choice<Multiplexing>("multiplexing", "tdm", "bpm", "ddm", "cdm");

// What the package knows as ep.Receiver, which the core carries along.
struct ReceiverKind {
  using Value = std::shared_ptr<const void>;
  static constexpr auto type_name = py::detail::const_name("object");
  static Value from(py::handle value, const char* argument) {
    if (!value.is_none() && !py::isinstance(value, py::module_::import("echopath.receiver").attr("Receiver")))
      refuse_type(argument, "must be a Receiver or None", value);
    return hold(py::reinterpret_borrow<py::object>(value));
  }
};

std::vector<std::vector<double>> rows_of(const std::optional<py::array_t<double, py::array::c_style>>& table) {
  std::vector<std::vector<double>> rows;
  if (!table) return rows;
  const auto length = static_cast<size_t>(table->shape(1));
  for (py::ssize_t row = 0; row < table->shape(0); ++row) {
    const double* const first = table->data() + static_cast<size_t>(row) * length;
    rows.emplace_back(first, first + length);
  }
  return rows;
}

// Level, the way the radar faces: a vehicle drives on the ground, wherever its radar looks up to.
std::shared_ptr<const Motion> motion_of(const std::optional<std::shared_ptr<Motion>>& motion,
                                        const std::optional<double>& speed, double yaw) {
  if (!speed) return motion.value_or(nullptr);
  require(!motion, "speed", "must not be given together with motion", *speed);
  require_below_light(*speed, "speed");
  return std::make_shared<LinearMotion>(*speed * Vec3(std::cos(yaw), std::sin(yaw), 0.0));
}

Radar radar(const Arg<"waveform", Instance<ChirpSequence>>& waveform,
            const Arg<"transmitters", List<Instance<Antenna>>>& transmitters,
            const Arg<"receivers", List<Instance<Antenna>>>& receivers, const Arg<"position", Vector3>& position,
            const Arg<"yaw", Real>& yaw, const Arg<"pitch", Real>& pitch,
            const Arg<"motion", Optional<Instance<std::shared_ptr<Motion>>>>& motion,
            const Arg<"speed", Optional<Real>>& speed, const Arg<"transmit_power", Real>& transmit_power,
            const Arg<"noise_figure_db", Real>& noise_figure_db,
            const Arg<"multiplexing", OneOf<kMultiplexing>>& multiplexing, const Arg<"empty_slots", Positive>& empty_slots,
            const Arg<"code_phases", Optional<Array<double, "[tx, slots]">>>& code_phases,
            const Arg<"receiver", ReceiverKind>& receiver) {
  Radar made{*waveform,        *transmitters,
             *receivers,       *transmit_power,
             *noise_figure_db, *multiplexing,
             *position,        *yaw,
             *pitch,           motion_of(*motion, *speed, *yaw),
             *empty_slots,     rows_of(*code_phases),
             *receiver};
  made.validate();
  made.validate_code_fits();
  require(made.code_phases.empty() || made.code_phases.size() == made.transmitters.size(), "code_phases",
          "must have one row for each transmitter", made.code_phases.size());
  require_plausible(made);
  warn_of_turns(made.yaw);
  return made;
}

py::object motion_object(const Radar& self) { return py::cast(shared(self.motion)); }

// Phases [tx, slots] in a new array, None where there is no code.
py::object code_phases_of(const Radar& self) {
  if (self.code_phases.empty()) return py::none();
  std::vector<double> values;
  for (const std::vector<double>& row : self.code_phases) values.insert(values.end(), row.begin(), row.end());
  const auto num_rows = std::ssize(self.code_phases);
  const auto length = std::ssize(self.code_phases.front());
  return numpy_take(std::move(values), {num_rows, length});
}

py::dict keywords_of_radar(const py::object& object) {
  const auto& self = object.cast<const Radar&>();
  return py::dict(py::arg("waveform") = self.waveform, py::arg("transmitters") = self.transmitters,
                  py::arg("receivers") = self.receivers, py::arg("position") = tuple_of(self.position),
                  py::arg("yaw") = self.yaw, py::arg("pitch") = self.pitch, py::arg("motion") = motion_object(self),
                  py::arg("transmit_power") = self.transmit_power, py::arg("noise_figure_db") = self.noise_figure_db,
                  py::arg("multiplexing") = kMultiplexing.name_of(self.multiplexing),
                  py::arg("empty_slots") = self.empty_slots, py::arg("code_phases") = code_phases_of(self),
                  py::arg("receiver") = held(self.receiver));
}

py::object replace_in_radar(const py::object& self, const py::kwargs& changes) {
  py::dict keywords = keywords_of_radar(self);
  if (changes.contains("speed")) keywords["motion"] = py::none();
  return detail::remade(py::type::of<Radar>(), keywords, changes);
}

double chirp_time(const Radar& self, const Arg<"tx", Count>& tx, const Arg<"chirp", Count>& chirp) {
  return self.chirp_time(*tx, *chirp);
}

py::array_t<double> world_from_radar(const Radar& self, const Arg<"time", Real>& time) {
  return to_numpy(self.world_from_radar(*time));
}

double middle_of_frame(const Radar& self, const Arg<"start_time", Real>& start_time) {
  return self.middle_of_frame(*start_time);
}

std::string text_of(const Radar& r) {
  return streamed("Radar(", part_text(r.waveform), ", ", counted(r.transmitters.size(), "transmitter"), ", ",
                  counted(r.receivers.size(), "receiver"), ", at ", place_text(r.position, r.yaw, r.pitch), ", ",
                  r.transmit_power, " W, noise figure ", r.noise_figure_db, " dB",
                  (r.takes_turns() ? "" : std::string(", ") + kMultiplexing.name_of(r.multiplexing)),
                  (r.receiver ? ", receiver with faults" : ""), (r.is_moving() ? ", moving" : ""), ")");
}

}  // namespace

void bind_radar(py::module_& m) {
  py::class_<Radar> type(m, "Radar", R"(Waveform, antennas, and where the radar that carries them is.

waveform: ChirpSequence
transmitters, receivers: Antenna, at least one each, placed in the radar's frame: x ahead, y left, z up
position: [3] m, in the world: the origin of the radar's frame
yaw: rad about the world's z, left positive, as in scene.add: yaw = pi / 2 looks along +y
pitch: rad, -pi/2 to pi/2, up positive: then about the radar's own +y, which stays level. The radar's +x becomes
    (cos pitch cos yaw, cos pitch sin yaw, sin pitch) in the world.
motion: Motion of the placed radar, or None at rest. Its axes are the world's, wherever the radar looks, as those of what
    scene.add places at the root are: at time t a point p of the radar's frame is at position + translation(t) +
    rotation(t) R_z(yaw) R_y(-pitch) p.
speed: m/s ahead, instead of a motion: level, along (cos yaw, sin yaw, 0), negative backwards; `motion` is then the
    LinearMotion of that velocity, which a later change of yaw leaves as it is
transmit_power: W per transmitter
noise_figure_db: dB, single sideband
multiplexing: "tdm": transmitters take turns, one slot each. With the others all send in every slot, and `synthesize` gives
    what a receiver has, [1, rx, slots, sample], until `demultiplex` takes it apart: "bpm": signs of a Hadamard matrix over
    num_slots slots, which make one of the num_chirps; "ddm": transmitter m turns by m / (transmitters + empty_slots) of a
    cycle from chirp to chirp; "cdm": by code_phases
empty_slots: of "ddm", at least 1: shares of the Doppler axis to which no transmitter is moved, which tell velocities apart;
    num_chirps must be a multiple of transmitters + empty_slots
code_phases: of "cdm", [tx, slots] rad: transmitter m turns by code_phases[m, i] in slot i, repeated
receiver: Receiver, the faults of the front end and the converter that follow the ideal signal, or None
Angles that are estimated count in the radar's axes. Radars of equal arguments are equal, and pickle.
Raises ValueError or TypeError naming the argument, for a speed of light or more, too. Warns (RuntimeWarning) of a yaw beyond
a turn, which looks like degrees.)");
  define_init(type, &radar, py::arg("waveform"), py::kw_only(), py::arg("transmitters"), py::arg("receivers"),
              py::arg("position") = py::make_tuple(0.0, 0.0, 0.0), py::arg("yaw") = 0.0, py::arg("pitch") = 0.0,
              py::arg("motion") = py::none(), py::arg("speed") = py::none(), py::arg("transmit_power") = 0.01,
              py::arg("noise_figure_db") = 12.0, py::arg("multiplexing") = "tdm", py::arg("empty_slots") = 1,
              py::arg("code_phases") = py::none(), py::arg("receiver") = py::none());
  type.def_readonly("waveform", &Radar::waveform, "ChirpSequence")
      .def_readonly("transmitters", &Radar::transmitters, "list of Antenna, a copy")
      .def_readonly("receivers", &Radar::receivers, "list of Antenna, a copy")
      .def_property_readonly("position", array_of(&Radar::position), "[3] m, in the world, without `motion`")
      .def_readonly("yaw", &Radar::yaw, "rad, left positive, without `motion`")
      .def_readonly("pitch", &Radar::pitch, "rad, up positive, without `motion`")
      .def_property_readonly("motion", &motion_object, "Motion of the placed radar in world axes, or None")
      .def_property_readonly("is_moving", &Radar::is_moving, "Whether it has a motion that moves it: one of 0 m/s does not")
      .def_readonly("transmit_power", &Radar::transmit_power, "W per transmitter")
      .def_readonly("noise_figure_db", &Radar::noise_figure_db, "dB, single sideband")
      .def_property_readonly("multiplexing", name_of(kMultiplexing, &Radar::multiplexing),
                             "\"tdm\", \"bpm\", \"ddm\" or \"cdm\"")
      .def_readonly("empty_slots", &Radar::empty_slots, "of \"ddm\": shares of the Doppler axis without a transmitter")
      .def_property_readonly("code_phases", &code_phases_of, "[tx, slots] rad of \"cdm\", or None")
      .def_property_readonly(
          "receiver", [](const Radar& self) { return held(self.receiver); }, "Receiver, or None")
      .def_property_readonly("num_slots", &Radar::num_slots,
                             "slots that make one of the num_chirps: of \"tdm\" one per transmitter, of \"bpm\" the length "
                             "of its code, else 1")
      .def_property_readonly("frame_duration", &Radar::frame_duration, "s, from the first sample to the last")
      .def("__repr__", [](const Radar& self) { return text_of(self); });
  define(type, "_repr_html_", from_package("presentation.notebook", "radar_html"), "A table for notebooks.");
  define(type, "chirp_time", &chirp_time, py::arg("tx"), py::arg("chirp"), R"(Time of the middle of a chirp.

tx, chirp: indices of the transmitter and of its chirp
Returns s after the frame's start. Raises IndexError.)");
  define(type, "middle_of_frame", &middle_of_frame, py::arg("start_time") = 0.0, R"(When the rays of a frame see the scene.

start_time: s, of the frame. Returns its middle in s. Raises TypeError or ValueError unless that is a finite number.)");
  define(type, "world_from_radar", &world_from_radar, py::arg("time"), R"(Where the radar's frame is in the world.

time: s
Returns [4, 4], translation in m. Raises ValueError where `motion` is not defined.)");
  define_value(type, &keywords_of_radar);
  define_no_change(type);
  define(type, "replace", &replace_in_radar, R"(A copy with some arguments of the constructor changed.

changes: keywords of Radar; a speed takes the place of the motion
Returns a Radar. Raises what Radar raises.)");
}

}  // namespace echopath::bindings
