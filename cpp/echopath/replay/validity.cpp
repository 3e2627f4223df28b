#include "echopath/replay/validity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numeric>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/parallel.h"
#include "echopath/base/phasor.h"
#include "echopath/replay/frame_check.h"

namespace echopath {
namespace {

constexpr int64_t kPathsPerBlock = 2048;
constexpr int64_t kBlocksInFlight = 64;   // fixed: sums must not depend on the number of threads
constexpr size_t kNumFrequencies = 64;    // over the band, for the power of the coherent sum
constexpr int64_t kLookRays = 1 << 16;    // for new surface, over all times and transmitters

// Sums of power over paths, W.
struct Sums {
  double power = 0.0, squared = 0.0, slid = 0.0, left = 0.0, blocked = 0.0, turned = 0.0;

  void add(const PathFinding& found, double phase) {
    const double p = found.power;
    const PathState& state = found.state;
    power += p;
    squared += p * phase * phase;
    if (phase > kPhaseLimit) slid += p;
    if (state.left != 0) left += p;
    if (state.blocked != 0 || state.is_receiver_blocked) blocked += p;
    if (state.is_turned) turned += p;
  }
  void add(const Sums& other, double scale = 1.0) {
    power += scale * other.power;
    squared += scale * other.squared;
    slid += scale * other.slid;
    left += scale * other.left;
    blocked += scale * other.blocked;
    turned += scale * other.turned;
  }
  ValidityShares shares() const {
    const double unit = power > 0 ? 1.0 / power : 0.0;
    return {power, unit * slid, unit * left, unit * blocked, unit * turned, 0.0};
  }
};

// Physical-optics paths add up as fields, the others as powers.
struct KindSums {
  Sums field, power;

  void add(const KindSums& other) {
    field.add(other.field);
    power.add(other.power);
  }
  Sums combined(double field_scale) const {
    Sums sum = power;
    sum.add(field, field_scale);
    return sum;
  }
};

struct Tally {
  KindSums whole;
  std::vector<KindSums> of_object;                              // by node index
  std::array<std::complex<double>, kNumFrequencies> field{};    // sqrt(W), sum of the physical-optics paths over the band
  double largest = 0.0, motion = 0.0, stepped = 0.0;            // rad
  double cosine_change = 0.0;

  explicit Tally(size_t num_nodes) : of_object(num_nodes) {}

  void add(const Tally& other) {
    whole.add(other.whole);
    for (size_t i = 0; i < of_object.size(); ++i) of_object[i].add(other.of_object[i]);
    for (size_t i = 0; i < field.size(); ++i) field[i] += other.field[i];
    largest = std::max(largest, other.largest);
    motion = std::max(motion, other.motion);
    stepped = std::max(stepped, other.stepped);
    cosine_change = std::max(cosine_change, other.cosine_change);
  }
  // From the sum of |a|^2 of the physical-optics paths to the power of their sum, mean over the band.
  double field_scale() const {
    double sum = 0.0;
    for (const std::complex<double>& value : field) sum += std::norm(value) / kNumFrequencies;
    return whole.field.power > 0 ? sum / whole.field.power : 1.0;
  }
};

bool is_field(const LocalPath& path) { return path.diffuse == 0 && path.last_material >= 0; }

class Certificate {
 public:
  Certificate(const Paths& paths, const Radar& radar, const std::vector<double>& times, const ValiditySettings& settings,
              Job* job)
      : paths_(paths), check_(paths, radar, times, settings.specular, job), keeps_arrays_(settings.arrays), job_(job) {
    const ChirpSequence& waveform = radar.waveform;
    first_turns_ = (waveform.start_frequency + 0.5 * waveform.bandwidth / kNumFrequencies) / kSpeedOfLight;
    turns_step_ = waveform.bandwidth / kNumFrequencies / kSpeedOfLight;
    report_.num_paths = paths.num_paths();
    report_.times = times;
    report_.has_array = check_.has_array();
    report_.specular = settings.specular;
  }

  Validity run() {
    if (keeps_arrays_) resize_arrays();
    const Tally tally = tally_all();
    fill_shares(tally);
    add_new_surface();
    return std::move(report_);
  }

 private:
  Tally tally_all() {
    const size_t num_nodes = paths_.scene->nodes().size();
    Tally sum(num_nodes);
    const int64_t num_blocks = (paths_.num_paths() + kPathsPerBlock - 1) / kPathsPerBlock;
    if (job_) job_->start(num_blocks);
    for (int64_t begin = 0; begin < num_blocks; begin += kBlocksInFlight) {
      std::vector<Tally> parts(static_cast<size_t>(std::min(kBlocksInFlight, num_blocks - begin)), Tally(num_nodes));
      const auto check = [&](int64_t i) { check_block(begin + i, parts[static_cast<size_t>(i)]); };
      parallel_for(static_cast<int64_t>(parts.size()), check, job_);
      for (const Tally& part : parts) sum.add(part);
    }
    return sum;
  }

  void check_block(int64_t block, Tally& tally) {
    const int64_t begin = block * kPathsPerBlock;
    std::vector<int64_t> indices(static_cast<size_t>(std::min(kPathsPerBlock, paths_.num_paths() - begin)));
    std::iota(indices.begin(), indices.end(), begin);
    const LocalPaths local = check_.localise(indices);
    FrameCheck::Scratch scratch(local.longest);
    for (size_t i = 0; i < indices.size(); ++i) {
      const PathFinding found = check_.check(local.paths[i], scratch);
      count(local.paths[i], found, tally);
      if (keeps_arrays_) keep(static_cast<size_t>(indices[i]), found);
    }
  }

  double phase(double length) const { return check_.wavenumber() * length; }
  LengthError error_of(const PathFinding& found) const { return check_.error_of(found.state); }

  void count(const LocalPath& path, const PathFinding& found, Tally& tally) const {
    const double slid = phase(error_of(found).largest);
    const bool adds_as_field = is_field(path);
    const LocalHit& hit = path.hits[std::max(path.last_material, 0)];
    KindSums& object = tally.of_object[static_cast<size_t>(paths_.scene->meshes()[hit.mesh_id].object)];
    (adds_as_field ? tally.whole.field : tally.whole.power).add(found, slid);
    (adds_as_field ? object.field : object.power).add(found, slid);
    if (adds_as_field) add_field(found, tally);
    if (!(found.power > 0)) return;
    tally.largest = std::max(tally.largest, slid);
    tally.motion = std::max(tally.motion, phase(error_of(found).motion));
    tally.stepped = std::max(tally.stepped, phase(found.state.stepped.largest));
    tally.cosine_change = std::max(tally.cosine_change, found.state.cosine_change);
  }

  void add_field(const PathFinding& found, Tally& tally) const {
    const Phasor first = phasor_of_product(first_turns_, found.length), step = phasor_of_product(turns_step_, found.length);
    std::complex<double> value = found.amplitude * std::complex<double>(first.re, -first.im);
    const std::complex<double> turn(step.re, -step.im);
    for (std::complex<double>& sum : tally.field) {
      sum += value;
      value *= turn;
    }
  }

  void resize_arrays() {
    ValidityArrays& arrays = report_.arrays;
    const auto size = static_cast<size_t>(paths_.num_paths());
    const auto resize = [size](auto&... columns) { (columns.resize(size), ...); };
    resize(arrays.power, arrays.phase_error, arrays.stepped_phase_error, arrays.left, arrays.blocked, arrays.receiver_blocked,
           arrays.turned, arrays.cosine_change);
  }

  void keep(size_t path, const PathFinding& found) {
    ValidityArrays& arrays = report_.arrays;
    arrays.power[path] = found.power;
    arrays.phase_error[path] = static_cast<float>(phase(error_of(found).largest));
    arrays.stepped_phase_error[path] = static_cast<float>(phase(found.state.stepped.largest));
    arrays.left[path] = found.state.left;
    arrays.blocked[path] = found.state.blocked;
    arrays.receiver_blocked[path] = found.state.is_receiver_blocked;
    arrays.turned[path] = found.state.is_turned;
    arrays.cosine_change[path] = static_cast<float>(found.state.cosine_change);
  }

  void fill_shares(const Tally& tally) {
    const double scale = tally.field_scale();
    const Sums whole = tally.whole.combined(scale);
    report_.shares = whole.shares();
    report_.rms_phase_error = whole.power > 0 ? std::sqrt(whole.squared / whole.power) : 0.0;
    report_.largest_phase_error = tally.largest;
    report_.motion_phase_error = tally.motion;
    report_.stepped_phase_error = tally.stepped;
    report_.largest_cosine_change = tally.cosine_change;
    of_object_.resize(tally.of_object.size());
    for (size_t i = 0; i < of_object_.size(); ++i) of_object_[i] = tally.of_object[i].combined(scale).shares();
  }

  void add_new_surface() {
    const auto share = [](double part, double whole) { return whole > 0 ? part / whole : 0.0; };
    const SurfaceSeen seen = check_.look(kLookRays, job_);
    report_.shares.new_surface = share(seen.hidden, seen.power);
    for (size_t i = 0; i < of_object_.size(); ++i) {
      of_object_[i].new_surface = share(seen.hidden_of[i], seen.power_of[i]);
      if (of_object_[i].power <= 0 && seen.power_of[i] <= 0) continue;
      report_.objects.push_back({paths_.scene->nodes()[i].name, of_object_[i]});
    }
    std::stable_sort(report_.objects.begin(), report_.objects.end(),
                     [](const auto& a, const auto& b) { return a.shares.power > b.shares.power; });
  }

  const Paths& paths_;
  FrameCheck check_;
  bool keeps_arrays_;
  Job* job_;
  double first_turns_, turns_step_;            // 1/m
  std::vector<ValidityShares> of_object_;      // by node index
  Validity report_;
};

std::vector<double> ends_of_frame(const Paths& paths, const Radar& radar) {
  const double start = paths.frame.start_time;
  const int last_tx = static_cast<int>(radar.transmitters.size()) - 1, last_chirp = radar.waveform.num_chirps - 1;
  return {start + radar.chirp_time(0, 0), start + radar.chirp_time(last_tx, last_chirp)};
}

}  // namespace

Validity validity(const Paths& paths, const Radar& radar, const ValiditySettings& settings, Job* job) {
  radar.validate();
  paths.scene->require_times(paths.frame.start_time, paths.frame.start_time + radar.frame_duration());
  for (const double time : settings.times) require(std::isfinite(time), "times", "must be finite", time);
  const std::vector<double> times = settings.times.empty() ? ends_of_frame(paths, radar) : settings.times;
  return Certificate(paths, radar, times, settings, job).run();
}

}  // namespace echopath
