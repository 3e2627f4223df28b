#include "echopath/radar/radar.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/range_of_coordinates.h"
#include "echopath/base/text/streamed.h"

namespace echopath {
namespace {

constexpr double kLongChirp = 1.0;  // s: of a sampling rate in MHz

// A chirp may fill its slot: num_samples / sampling_rate may round above the interval by an ulp or two.
constexpr double kSlotTolerance = 1e-9;
// Of the sine of phases that are meant as signs, multiples of pi.
constexpr double kSignRounding = 1e-12;

void require_positive(double value, const std::string& argument) {
  require(std::isfinite(value) && value > 0.0, argument, "must be finite and positive", value);
}

void validate_antenna(const Antenna& antenna, const std::string& name) {
  require_in_range(antenna.position, name + ".position", "the antenna");
  const double quaternion_norm = antenna.orientation.norm();
  require(std::abs(quaternion_norm - 1.0) <= kUnitTolerance, name + ".orientation", "must have norm 1 within 1e-6",
          quaternion_norm);
  const double polarization_norm = antenna.polarization.norm();
  require(std::abs(polarization_norm - 1.0) <= kUnitTolerance, name + ".polarization", "must have norm 1 within 1e-6",
          polarization_norm);
  require_positive(antenna.pattern.peak_gain, name + ".pattern.peak_gain");
  require((antenna.pattern.kind == AntennaPattern::Kind::kTable) == (antenna.pattern.table != nullptr),
          name + ".pattern.table", "must be given for the kind table and for no other", antenna.pattern.table != nullptr);
  const double exponent = antenna.pattern.exponent;
  require(std::isfinite(exponent) && exponent >= 0.0, name + ".pattern.exponent", "must be finite and not negative",
          exponent);
}

void validate_antennas(const std::vector<Antenna>& antennas, const std::string& name) {
  require(!antennas.empty(), name, "must hold at least one antenna", antennas.size());
  for (size_t i = 0; i < antennas.size(); ++i) validate_antenna(antennas[i], name + "[" + std::to_string(i) + "]");
}

void require_index(int index, int count, const char* name) {
  if (index >= 0 && index < count) return;
  throw std::out_of_range(std::string(name) + ": must be in [0, " + std::to_string(count) + "), got " +
                          std::to_string(index));
}

void validate_list(const std::vector<double>& values, const char* argument, double least, const char* rule) {
  for (const double value : values) require(std::isfinite(value) && value > least, argument, rule, value);
}

double sum_of(const std::vector<double>& values, size_t count) {
  return std::accumulate(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(count), 0.0);
}

bool has_complex_code(const Radar& radar) {
  if (radar.multiplexing == Multiplexing::kDdm) return radar.transmitters.size() > 1;  // at least three phases in a turn
  const auto is_complex = [](double phase) { return std::abs(std::sin(phase)) > kSignRounding; };
  return std::ranges::any_of(radar.code_phases, [&](const auto& row) { return std::ranges::any_of(row, is_complex); });
}

void validate_code(const Radar& radar) {
  require(radar.empty_slots >= 1, "empty_slots", "must be at least 1", radar.empty_slots);
  const bool has_code = radar.multiplexing == Multiplexing::kCdm;
  require(has_code == !radar.code_phases.empty(), "code_phases", "must be given for cdm and for nothing else",
          radar.code_phases.size());
  for (const std::vector<double>& row : radar.code_phases) {
    require(!row.empty() && row.size() == radar.code_phases.front().size(), "code_phases",
            "must have rows of one length, at least 1", row.size());
    for (const double phase : row) require(std::isfinite(phase), "code_phases", "must be finite", phase);
  }
}

// Replay asks for gains once per path, antenna and instant: the usual whole exponents must not cost a call of pow.
double power_of(double base, double exponent) {
  constexpr int kLargestWhole = 16;
  const int whole = exponent <= kLargestWhole ? static_cast<int>(exponent) : 0;
  if (whole != exponent) return std::pow(base, exponent);
  double power = 1.0;
  for (int i = 0; i < whole; ++i) power *= base;
  return power;
}

}  // namespace

void ChirpSequence::validate() const {
  require_positive(start_frequency, "start_frequency");
  require(std::isfinite(bandwidth) && bandwidth != 0.0, "bandwidth", "must be finite and not 0, negative where chirps fall",
          bandwidth);
  require(start_frequency + bandwidth > 0.0, "bandwidth", "must leave positive frequencies where chirps fall", bandwidth);
  require(num_samples >= 1, "num_samples", "must be at least 1", num_samples);
  require_positive(sampling_rate, "sampling_rate");
  require(num_chirps >= 1, "num_chirps", "must be at least 1", num_chirps);
  require_positive(chirp_interval, "chirp_interval");
  require(chirp_interval >= chirp_duration() * (1.0 - kSlotTolerance), "chirp_interval",
          streamed("must be at least num_samples / sampling_rate = ", chirp_duration(), " s",
                   chirp_duration() > kLongChirp ? ", with sampling_rate in Hz" : ""),
          chirp_interval);
  validate_list(extra_idle, "extra_idle", -std::numeric_limits<double>::min(), "must be finite and not negative");
  validate_list(frequency_steps, "frequency_steps", -start_frequency, "must be finite and leave a positive start_frequency");
  for (const double step : bandwidth_steps) {
    require(std::isfinite(step) && (bandwidth + step) * bandwidth > 0.0, "bandwidth_steps",
            "must be finite and leave chirps that all rise or all fall", step);
  }
  require(band().lowest > 0.0, "bandwidth", "must leave positive frequencies where chirps fall", bandwidth);
}

double ChirpSequence::wavelength() const { return kSpeedOfLight / centre_frequency(); }

FrequencyBand ChirpSequence::band() const {
  const std::vector<double> no_steps = {0.0};
  const std::vector<double>& starts = frequency_steps.empty() ? no_steps : frequency_steps;
  const std::vector<double>& widths = bandwidth_steps.empty() ? no_steps : bandwidth_steps;
  // Of two lists that repeat, those steps meet in a chirp whose places agree modulo the lengths' greatest common divisor.
  const size_t stride = std::gcd(starts.size(), widths.size());
  const double upward = falls() ? -1.0 : 1.0;
  const auto farthest = [&](const std::vector<double>& steps, size_t first) {
    double out = upward * steps[first];
    for (size_t i = first; i < steps.size(); i += stride) out = std::max(out, upward * steps[i]);
    return out;
  };
  double last = farthest(starts, 0) + farthest(widths, 0);
  for (size_t first = 1; first < stride; ++first) last = std::max(last, farthest(starts, first) + farthest(widths, first));
  const double end = start_frequency + bandwidth + upward * last;
  if (falls()) return {end, start_frequency + std::ranges::max(starts)};
  return {start_frequency + std::ranges::min(starts), end};
}

double ChirpSequence::mean_interval() const {
  if (extra_idle.empty()) return chirp_interval;
  return chirp_interval + sum_of(extra_idle, extra_idle.size()) / static_cast<double>(extra_idle.size());
}

double ChirpSequence::slot_start(int64_t slot) const {
  // This is one product with an exact integer, so that the spacing is equal up to one rounding, however long the frame.
  const double even = static_cast<double>(slot) * chirp_interval;
  if (extra_idle.empty()) return even;
  const auto length = std::ssize(extra_idle);
  const int64_t num_whole = slot / length;
  return even + static_cast<double>(num_whole) * sum_of(extra_idle, extra_idle.size()) +
         sum_of(extra_idle, static_cast<size_t>(slot % length));
}

double ChirpSequence::range_resolution() const { return kSpeedOfLight / (2.0 * std::abs(bandwidth)); }

double ChirpSequence::max_range() const { return (real ? 0.5 : 1.0) * num_samples * range_resolution(); }

double ChirpSequence::velocity_resolution(int num_slots) const {
  require(num_slots >= 1, "num_slots", "must be at least 1", num_slots);
  return wavelength() / (2.0 * num_chirps * num_slots * mean_interval());
}

double ChirpSequence::max_velocity(int num_slots) const { return 0.5 * num_chirps * velocity_resolution(num_slots); }

AntennaPattern AntennaPattern::isotropic(double gain) {
  require_positive(gain, "gain");
  require(
      gain <= kLargestEfficiency, "gain",
      "must be at most 1, as the same gain in every direction is the efficiency; CosinePower and GainTable have more ahead",
      gain);
  return {Kind::kIsotropic, gain, 0.0, nullptr};
}

AntennaPattern AntennaPattern::cosine_power(double exponent, double peak_gain) {
  require(std::isfinite(exponent) && exponent >= 0.0, "exponent", "must be finite and not negative", exponent);
  require(std::isfinite(peak_gain), "peak_gain", "must be finite", peak_gain);
  const double lossless = 2.0 * (exponent + 1.0);
  require(peak_gain <= kLargestEfficiency * lossless, "peak_gain",
          streamed("must be at most that of an antenna without losses, 2 (exponent + 1) = ", lossless), peak_gain);
  return {Kind::kCosinePower, peak_gain > 0.0 ? peak_gain : lossless, exponent, nullptr};
}

AntennaPattern AntennaPattern::of_table(GainTable table) {
  const double peak_gain = table.peak_gain();
  return {Kind::kTable, peak_gain, 0.0, std::make_shared<const GainTable>(std::move(table))};
}

double AntennaPattern::gain(double cos_boresight) const {
  require(kind != Kind::kTable, "cos_boresight", "tells no gain of a table, which needs a direction", cos_boresight);
  if (kind == Kind::kIsotropic) return peak_gain;
  return cos_boresight > 0.0 ? peak_gain * power_of(cos_boresight, exponent) : 0.0;
}

double AntennaPattern::largest_field() const { return table ? table->largest_field() : std::sqrt(peak_gain); }

double AntennaPattern::sharpness() const {
  if (kind == Kind::kTable) return table->sharpness();
  return kind == Kind::kIsotropic || exponent == 0.0 ? 0.0 : std::max(1.0, std::sqrt(0.5 * exponent));
}

double AntennaPattern::efficiency() const {
  if (kind == Kind::kTable) return table->efficiency();
  return kind == Kind::kIsotropic ? peak_gain : peak_gain / (2.0 * (exponent + 1.0));
}

bool AntennaPattern::is_dark_behind() const {
  return kind == Kind::kTable ? table->is_dark_behind() : kind == Kind::kCosinePower;
}

Quaternion turned(double yaw, double pitch) {
  return Quaternion(Eigen::AngleAxisd(yaw, Vec3::UnitZ())) * Quaternion(Eigen::AngleAxisd(-pitch, Vec3::UnitY()));
}

bool have_one_beam(const Antenna& a, const Antenna& b) {
  return a.pattern.kind == b.pattern.kind && a.pattern.exponent == b.pattern.exponent &&
         a.pattern.table == b.pattern.table && a.orientation.coeffs() == b.orientation.coeffs();
}

Vec3 mean_position(const std::vector<Antenna>& antennas, const Transform& world_from_radar) {
  Vec3 sum = Vec3::Zero();
  for (const Antenna& antenna : antennas) sum += world_from_radar * antenna.position;
  const Vec3 mean = sum / static_cast<double>(antennas.size());
  require_in_range(mean, "radar", "antennas");
  return mean;
}

Vec3 sum_of_boresights(const std::vector<Antenna>& antennas) {
  Vec3 sum = Vec3::Zero();
  for (const Antenna& antenna : antennas) sum += antenna.orientation * Vec3::UnitX();
  return sum;
}

void Radar::validate() const {
  waveform.validate();
  validate_antennas(transmitters, "transmitters");
  validate_antennas(receivers, "receivers");
  require_positive(transmit_power, "transmit_power");
  require(std::isfinite(noise_figure_db) && noise_figure_db >= 0.0, "noise_figure_db", "must be finite and not negative",
          noise_figure_db);
  require(!motion || motion->is_rigid(), "motion", "must keep lengths", "one with scales");
  require_in_range(position, "position", "the radar");
  require(std::isfinite(yaw), "yaw", "must be finite", yaw);
  require(std::abs(pitch) <= 0.5 * kPi, "pitch", "must be from -pi/2 to pi/2 rad", pitch);
  validate_code(*this);
}

void Radar::validate_code_fits() const {
  if (multiplexing == Multiplexing::kDdm) {
    const int64_t shares = std::ssize(transmitters) + empty_slots;
    require(waveform.num_chirps % shares == 0, "waveform.num_chirps",
            "must be a multiple of transmitters + empty_slots = " + std::to_string(shares), waveform.num_chirps);
  }
  require(!waveform.real || !has_complex_code(*this), "waveform.real",
          "must be False with a code of phases, which needs complex samples", "True");
}

int Radar::num_slots() const {
  if (multiplexing == Multiplexing::kTdm) return static_cast<int>(transmitters.size());
  return multiplexing == Multiplexing::kBpm ? static_cast<int>(std::bit_ceil(transmitters.size())) : 1;
}

Transform Radar::world_from_radar(double time) const {
  return moved(Eigen::Translation3d(position) * turned(yaw, pitch), motion.get(), time);
}

double Radar::chirp_time(int tx, int chirp) const {
  require_index(tx, static_cast<int>(transmitters.size()), "tx");
  require_index(chirp, waveform.num_chirps, "chirp");
  return waveform.slot_start(int64_t{chirp} * num_slots() + (takes_turns() ? tx : 0)) + waveform.window_centre();
}

double Radar::frame_duration() const {
  const int64_t last_slot = int64_t{waveform.num_chirps} * num_slots() - 1;
  return waveform.slot_start(last_slot) + (waveform.num_samples - 1) / waveform.sampling_rate;
}

Radar one_channel(const Radar& radar, size_t tx, size_t rx) {
  Radar one = radar;
  one.transmitters = {radar.transmitters[tx]};
  one.receivers = {radar.receivers[rx]};
  return one;
}

}  // namespace echopath
