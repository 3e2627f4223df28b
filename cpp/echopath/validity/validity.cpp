#include "echopath/validity/validity.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <span>

#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/radar/noise_power.h"
#include "echopath/validity/frame/path_sample.h"
#include "echopath/validity/power_sums.h"
#include "echopath/validity/surface/seen_powers.h"
#include "echopath/validity/validity_objects.h"

namespace echopath {
namespace {

constexpr int64_t kPathsPerBlock = 2048;
constexpr int64_t kBlocksInFlight = 64;  // fixed: sums must not depend on the number of threads

bool is_field(const LocalPath& path) { return path.diffuse == 0 && path.last_material >= 0; }

class ValidityCheck {
 public:
  ValidityCheck(const Paths& paths, const Radar& radar, CheckTimes times, const ValiditySettings& settings, Job* job)
      : paths_(paths), radar_(radar), check_(paths, radar, std::move(times), settings.specular, job),
        sample_(sample_of(paths, settings.arrays)), band_(radar.waveform), keeps_arrays_(settings.arrays), job_(job) {
    report_.num_paths = paths.num_paths();
    report_.times = check_.times().times;
    report_.has_array = check_.has_array();
    report_.is_still = !check_.anything_moves();
    report_.specular = settings.specular;
    report_.cell_noise = noise_power_in_cell(radar);
  }

  Validity run() {
    findings_.resize(sample_.paths.size());
    for (size_t first = 0; first < report_.times.size(); first += check_.times_at_once()) check_times_from(first);
    sum_findings();
    seen_ = find_seen_powers(paths_, radar_, check_, at_times_, job_);
    for (const auto& [node, looks] : seen_) all_seen_ += looks.seen;
    make_objects();
    return std::move(report_);
  }

 private:
  // Holds what is kept of a path between the times.
  struct Finding : PathFinding {
    int num_times = 0;  // times that it needs
    size_t object = 0;  // node index
    bool is_field = false;
    Echo at_trace;
  };

  size_t num_base() const { return static_cast<size_t>(check_.times().num_base); }

  // Returns the paths of the sample that need times from `first` on.
  std::vector<size_t> members_from(size_t first) const {
    std::vector<size_t> members;
    for (size_t i = 0; i < findings_.size(); ++i) {
      if (first == 0 || findings_[i].num_times > static_cast<int>(first)) members.push_back(i);
    }
    return members;
  }

  void check_times_from(size_t first) {
    const std::vector<size_t> members = members_from(first);
    if (first > 0 && members.empty()) return;
    check_.pose(first, job_);
    const int64_t size = std::ssize(members), num_blocks = num_chunks(size, kPathsPerBlock);
    if (job_) job_->start(num_blocks);
    for (int64_t begin = 0; begin < num_blocks; begin += kBlocksInFlight) {
      std::vector<ObjectsAtTimes> parts(std::min(kBlocksInFlight, num_blocks - begin));
      const auto check = [&](int64_t i) {
        const int64_t from = (begin + i) * kPathsPerBlock;
        const std::span<const size_t> some(members.data() + from,
                                           static_cast<size_t>(std::min(kPathsPerBlock, size - from)));
        check_block(some, first, parts[i]);
      };
      parallel_for(std::ssize(parts), check, job_);
      for (const ObjectsAtTimes& part : parts) add(part, at_times_);
    }
  }

  void check_block(std::span<const size_t> members, size_t first, ObjectsAtTimes& sums) {
    std::vector<int64_t> indices;
    for (const size_t member : members) indices.push_back(sample_.paths[member]);
    const LocalPaths local = check_.prepare(indices);
    FrameCheck::Scratch scratch(local.longest);
    std::vector<Echo> traced;
    if (first == 0) traced = check_.at_trace(indices);
    else
      for (const size_t member : members) traced.push_back(findings_[member].at_trace);
    std::vector<Echo> posed = check_.at_posed_times(indices, local, traced);
    for (size_t i = 0; i < members.size(); ++i) {
      Finding& found = findings_[members[i]];
      const LocalPath& path = local.paths[i];
      if (first == 0) begin_path(path, traced[i], found);
      const std::span<Echo> echoes(posed.data() + i * check_.num_posed_times(), check_.num_posed_times());
      const size_t num_needed = check_.check(path, found.num_times, found.at_trace, echoes, scratch, found);
      add_echoes(found, sample_.weights[members[i]], first, echoes.first(num_needed), sums);
    }
  }

  void begin_path(const LocalPath& path, const Echo& traced, Finding& found) const {
    found.num_times = check_.times_of(path);
    found.object = static_cast<size_t>(paths_.scene->meshes()[path.hits[std::max(path.last_material, 0)].mesh_id].object);
    found.is_field = is_field(path);
    found.at_trace = traced;
  }

  // Adds the echoes at the base times only, at which surface is looked for, too.
  void add_echoes(const Finding& found, double weight, size_t first, std::span<const Echo> echoes,
                  ObjectsAtTimes& sums) const {
    if (first >= num_base()) return;
    std::vector<ObjectAtTime>& times = sums[found.object];
    times.resize(num_base());
    for (size_t i = 0; i < echoes.size() && first + i < num_base(); ++i) {
      times[first + i].replayed.add(echoes[i], found.is_field, weight, band_);
      if (echoes[i].is_lost) times[first + i].lost.add(echoes[i], found.is_field, weight, band_);
      else if (echoes[i].edge_ratio != 1.0) times[first + i].edges.add(change_by_edges(echoes[i], found.is_field, weight));
    }
  }

  // Returns what the replay lacks of an echo, since edges leave another share of its field than at the trace.
  BandSum change_by_edges(const Echo& echo, bool is_field, double weight) const {
    Echo there = echo;
    there.amplitude *= echo.edge_ratio;
    BandSum change;
    change.add(there, is_field, weight, band_);
    BandSum replayed;
    replayed.add(echo, is_field, weight, band_);
    change.add(replayed, -1.0);
    return change;
  }

  double phase(double length) const { return check_.wavenumber() * length; }

  void sum_findings() {
    if (keeps_arrays_) resize_arrays();
    KindSums whole;
    for (size_t i = 0; i < findings_.size(); ++i) {
      const Finding& found = findings_[i];
      const double slid = phase(check_.error_of(found.state).largest), power = sample_.weights[i] * found.mean_power();
      for (KindSums* sums : {&whole, &of_object_[found.object]}) {
        (found.is_field ? sums->field : sums->power).add(found.state, power, slid);
        if (found.is_field) sums->together.add(found.at_trace, true, sample_.weights[i], band_);
      }
      if (keeps_arrays_) keep(i, found);
      if (!(power > 0)) continue;
      raise(report_.largest_phase_error, slid);
      raise(report_.motion_phase_error, phase(check_.error_of(found.state).motion));
      raise(report_.stepped_phase_error, phase(found.state.stepped.largest));
      raise(report_.largest_cosine_change, found.state.cosine_change);
      raise(report_.largest_edge_change, found.state.edge_change);
      if (found.state.edge_change > kEdgeLimit) raise(report_.edge_slide, found.state.edge_slide);
    }
    const PowerSums sum = whole.combined(whole.field_scale());
    report_.shares = sum.shares();
    report_.rms_phase_error = sum.power > 0 ? std::sqrt(sum.squared / sum.power) : 0.0;
  }

  static void raise(double& largest, double value) { largest = std::max(largest, value); }

  void resize_arrays() {
    ValidityArrays& arrays = report_.arrays;
    const auto size = static_cast<size_t>(paths_.num_paths());
    const auto resize = [size](auto&... columns) { (columns.resize(size), ...); };
    resize(arrays.power, arrays.phase_error, arrays.stepped_phase_error, arrays.left, arrays.blocked,
           arrays.receiver_blocked, arrays.turned, arrays.cosine_change, arrays.edge_change);
  }

  void keep(size_t path, const PathFinding& found) {
    ValidityArrays& arrays = report_.arrays;
    arrays.power[path] = found.mean_power();
    arrays.phase_error[path] = static_cast<float>(phase(check_.error_of(found.state).largest));
    arrays.stepped_phase_error[path] = static_cast<float>(phase(found.state.stepped.largest));
    arrays.left[path] = found.state.left;
    arrays.blocked[path] = found.state.blocked;
    arrays.receiver_blocked[path] = found.state.is_receiver_blocked;
    arrays.turned[path] = found.state.is_turned;
    arrays.cosine_change[path] = static_cast<float>(found.state.cosine_change);
    arrays.edge_change[path] = static_cast<float>(found.state.edge_change);
  }

  void make_objects() {
    std::vector<double> turn(of_object_.size());
    std::vector<uint8_t> is_too_fast(of_object_.size());
    const CheckTimes& times = check_.times();
    for (size_t id = 0; id < times.turn.size(); ++id) raise(turn[object_of(id)], times.turn[id]);
    for (const uint32_t id : times.too_fast) is_too_fast[object_of(id)] = 1;
    report_.turn_of_radar = times.turn_of_radar;
    report_.is_radar_too_fast = times.is_radar_too_fast;
    double strongest = 0.0;
    for (size_t i = 0; i < of_object_.size(); ++i) {
      ObjectValidity object = make_object(i);
      object.turn = turn[i];
      object.is_too_fast = is_too_fast[i] != 0;
      if (object.power <= 0 && object.seen_power <= 0) continue;
      raise(strongest, std::max(object.power, object.seen_power));
      report_.objects.push_back(std::move(object));
    }
    const double floor = std::max(strongest * std::pow(10.0, -0.1 * kDynamicRangeDb), report_.cell_noise);
    for (ObjectValidity& object : report_.objects) object.is_in_range = std::max(object.power, object.seen_power) >= floor;
    std::ranges::stable_sort(report_.objects, std::greater(), &ObjectValidity::power);
  }

  size_t object_of(size_t mesh_id) const { return static_cast<size_t>(paths_.scene->meshes()[mesh_id].object); }

  ObjectValidity make_object(size_t node) {
    ObjectValidity object;
    static_cast<ValidityShares&>(object) = of_object_[node].combined(of_object_[node].field_scale()).shares();
    object.name = paths_.scene->nodes()[node].name;
    object.has_paths = object.power > 0;
    const bool is_whole = paths_.num_paths() == paths_.frame.statistics.num_paths;
    object.is_asked = is_whole || object.has_paths;
    const SeenPower& looks = seen_[node];
    const double fresh = std::min(looks.fresh, looks.seen);  // a part of an echo may have more power than the whole
    object.new_surface = looks.seen > 0 ? fresh / looks.seen : 0.0;
    report_.shares.new_surface += all_seen_ > 0 ? fresh / all_seen_ : 0.0;
    double replayed = 0.0, kept = 0.0, truth = 0.0;
    for (const ObjectAtTime& at : at_times_[node]) {
      BandSum left = at.replayed;
      left.add(at.lost, -1.0);
      replayed += at.replayed.power();
      kept += left.power();
      truth += at.true_power();
    }
    object.seen_power = looks.largest;
    if (replayed > 0) object.disappears = std::max(0.0, 1.0 - kept / replayed);
    if (is_whole && replayed > 0 && truth > 0) object.error_db = 10.0 * std::log10(replayed / truth);
    return object;
  }

  const Paths& paths_;
  const Radar& radar_;
  FrameCheck check_;
  PathSample sample_;
  BandSum::Band band_;
  bool keeps_arrays_;
  Job* job_;
  std::vector<Finding> findings_;                                  // of the sample
  std::vector<KindSums> of_object_{paths_.scene->nodes().size()};  // by node index
  ObjectsAtTimes at_times_;                                        // at the base times, for the first antennas
  std::map<size_t, SeenPower> seen_;                               // by node index
  double all_seen_ = 0.0;                                          // W, of all of them
  Validity report_;
};

}  // namespace

bool ObjectValidity::ok() const {
  if (!is_in_range || !is_asked) return true;
  if (!has_paths || is_too_fast || std::abs(error_db) > kObjectErrorDb) return false;
  return std::max({slid, left, blocked, turned, beside_edges, new_surface}) <= kObjectLimit;
}

Validity validity(const Paths& paths, const Radar& radar, const ValiditySettings& settings, Job* job) {
  radar.validate();
  const double start = paths.frame.start_time;
  paths.scene->require_times(start, start + radar.frame_duration());
  for (const double time : settings.times) require(std::isfinite(time), "times", "must be finite", time);
  CheckTimes times = settings.times.empty() ? check_times(*paths.scene, radar, start)
                                            : given_check_times(*paths.scene, radar, start, settings.times);
  return ValidityCheck(paths, radar, std::move(times), settings, job).run();
}

}  // namespace echopath
