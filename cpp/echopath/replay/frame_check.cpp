#include "echopath/replay/frame_check.h"

#include <algorithm>

namespace echopath {
namespace {

Radar with_first_antennas(Radar radar) {
  radar.transmitters.resize(1);
  radar.receivers.resize(1);
  return radar;
}

std::vector<uint8_t> moving_meshes(const Scene& scene) {
  std::vector<uint8_t> moves;
  for (uint32_t id = 0; id < scene.meshes().size(); ++id) moves.push_back(scene.is_moving(id));
  return moves;
}

void merge(const LengthError& at, LengthError& worst) {
  worst.motion = std::max(worst.motion, at.motion);
  worst.largest = std::max(worst.largest, at.largest);
}

// The worse of two times.
void merge(const PathState& at, PathState& worst) {
  merge(at.frozen, worst.frozen);
  merge(at.stepped, worst.stepped);
  worst.left |= at.left;
  worst.blocked |= at.blocked;
  worst.is_receiver_blocked |= at.is_receiver_blocked;
  worst.is_turned |= at.is_turned;
  worst.cosine_change = std::max(worst.cosine_change, at.cosine_change);
}

}  // namespace

FrameCheck::Scratch::Scratch(int longest) : probe(longest), evaluation(longest) {}

// One time of the frame.
struct FrameCheck::View {
  std::shared_ptr<const EmbreeScene> geometry;
  Pose pose;
  Instant first_antennas, rim;
  FrameProbe probe;

  View(const FrameCheck& check, std::shared_ptr<const EmbreeScene> posed, double time)
      : geometry(std::move(posed)), pose(*check.paths_.scene, time),
        first_antennas(*check.paths_.scene, check.first_radar_, check.localise_.patches(), check.origin_, time),
        rim(*check.paths_.scene, check.probe_radar_, check.localise_.patches(), check.origin_, time),
        probe(check.localise_, pose, rim, *geometry, check.walk_, check.radio_.wavenumber) {}
};

FrameCheck::FrameCheck(const Paths& paths, const Radar& radar, std::vector<double> times, SpecularPoints specular, Job* job)
    : paths_(paths), probe_radar_(probe_radar(paths, radar)), first_radar_(with_first_antennas(radar)),
      localise_(paths, whole_patches(*paths.scene)),
      walk_(*paths.scene, localise_.smooth_normals()), radio_(radio_constants(paths, radar)),
      mesh_moves_(moving_meshes(*paths.scene)) {
  radio_.specular = specular;
  is_geometry_still_ = std::count(mesh_moves_.begin(), mesh_moves_.end(), 1) == 0;
  is_still_ = is_geometry_still_ && !radar.motion;
  if (is_still_ && times.size() > 1) times.erase(times.begin() + 1, times.end());
  const Pose pose(*paths.scene, paths.frame.trace_time);
  origin_ = EmbreeScene::origin_near(*paths.scene, pose, paths.frame.transmitter);
  const auto traced = std::make_shared<const EmbreeScene>(*paths.scene, pose, origin_, job);
  trace_view_ = std::make_unique<const View>(*this, traced, paths.frame.trace_time);
  for (const double time : times) {
    auto posed = traced;
    if (!is_geometry_still_) posed = std::make_shared<const EmbreeScene>(*paths.scene, Pose(*paths.scene, time), origin_, job);
    views_.push_back(std::make_unique<const View>(*this, posed, time));
  }
}

FrameCheck::~FrameCheck() = default;

bool FrameCheck::is_still(const LocalPath& path) const {
  const auto moves = [&](const LocalHit& hit) { return mesh_moves_[hit.mesh_id] != 0; };
  return is_still_ || (!first_radar_.motion && std::none_of(path.hits, path.hits + path.count, moves));
}

void FrameCheck::evaluate(const LocalPath& path, Scratch& scratch, PathFinding& found) const {
  evaluate_path(path, trace_view_->first_antennas, radio_, scratch.evaluation, {&found.length, &found.amplitude, 1});
  found.power = std::norm(found.amplitude);
  if (is_still(path)) return;
  double length;
  std::complex<double> amplitude;
  for (const auto& view : views_) {
    evaluate_path(path, view->first_antennas, radio_, scratch.evaluation, {&length, &amplitude, 1});
    found.power += std::norm(amplitude);
  }
  found.power /= static_cast<double>(views_.size() + 1);
}

PathFinding FrameCheck::check(const LocalPath& path, Scratch& scratch) const {
  PathFinding found;
  evaluate(path, scratch, found);
  trace_view_->probe.cosines(path, scratch.probe, scratch.probe.reference);
  scratch.known.resize(views_.size());
  for (size_t i = 0; i < views_.size(); ++i) merge(views_[i]->probe.check(path, scratch.probe, scratch.known[i]), found.state);
  return found;
}

SurfaceSeen FrameCheck::look(int64_t num_rays, Job* job) const {
  const TraceView trace{*trace_view_->geometry, paths_.frame.transmitter - origin_, paths_.frame.receiver - origin_};
  const auto num_looks = static_cast<int64_t>(views_.size() * probe_radar_.transmitters.size());
  SurfaceSeen seen(*paths_.scene);
  for (const auto& view : views_) {
    seen.add(look_for_new_surface(*paths_.scene, first_radar_.waveform.start_frequency, view->rim, *view->geometry, trace,
                                  std::max<int64_t>(1, num_rays / std::max<int64_t>(1, num_looks)), job));
  }
  return seen;
}

}  // namespace echopath
