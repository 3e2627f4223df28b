#include "echopath/replay/factors/lobe_factors.h"

#include <cmath>

namespace echopath {
namespace {

// Finds the lobes along one path after the other, at one node after the other.
class PathLobes {
 public:
  explicit PathLobes(const PathPreparer& preparer) : lobes_(preparer.lobes()), hits_(64) {}

  void pose(const LocalPath& path, const PosedScene& scene) {
    path_ = &path;
    pose_hits(path, scene, hits_.data());
    find_arrivals(scene.antennas(path.is_reversed));
    find_departures(scene.antennas(!path.is_reversed));
  }

  // Returns the factor of the amplitude between two antennas.
  double factor(size_t transmitter, size_t receiver) const {
    const size_t start = path_->is_reversed ? receiver : transmitter, end = path_->is_reversed ? transmitter : receiver;
    double product = 1.0;
    for (int k = path_->first_material; k <= path_->last_material; ++k) {
      if (!path_->is_diffuse(k)) continue;
      const DiffuseLobe& lobe = lobes_[path_->hits[k].mesh_id];
      if (!lobe.is_lambert()) product *= lobe.over_lambert(geometry(k, start, end));
    }
    return std::sqrt(product);
  }

 private:
  // A path that was traced from its receiver is travelled the other way.
  ScatterGeometry geometry(int hit, size_t start, size_t end) const {
    const Vec3 in =
        hit == path_->first_material ? arrivals_[start] : inner_leg(hits_.data(), material_before(hit), hit).arrival;
    const Vec3 out =
        hit == path_->last_material ? departures_[end] : inner_leg(hits_.data(), hit, material_behind(hit)).departure;
    const Vec3& normal = hits_[hit].normal;
    return path_->is_reversed ? ScatterGeometry{-out, normal, -in} : ScatterGeometry{in, normal, out};
  }

  int material_before(int hit) const {
    do --hit;
    while (path_->is_image(hit));
    return hit;
  }
  int material_behind(int hit) const {
    do ++hit;
    while (path_->is_image(hit));
    return hit;
  }

  void find_arrivals(const std::vector<PosedAntenna>& antennas) {
    const int first = path_->first_material;
    arrivals_.clear();
    for (const PosedAntenna& antenna : antennas) {
      arrivals_.push_back(unfolded_leg(hits_.data(), antenna.position, 0, first, point(first)).arrival);
    }
  }

  void find_departures(const std::vector<PosedAntenna>& antennas) {
    const int last = path_->last_material;
    departures_.clear();
    for (const PosedAntenna& antenna : antennas) {
      departures_.push_back(unfolded_leg(hits_.data(), point(last), last + 1, path_->count, antenna.position).departure);
    }
  }

  const Vec3& point(int hit) const { return hits_[hit].point; }

  const std::vector<DiffuseLobe>& lobes_;
  std::vector<PosedHit> hits_;
  const LocalPath* path_ = nullptr;
  std::vector<Vec3> arrivals_, departures_;  // unit; at the first and the last material point, of each antenna there
};

}  // namespace

void apply_lobes(const SharedLegPlan& plan, const PathPreparer& preparer, const PosedNodes& nodes,
                 const ChannelSpan& channels) {
  if (plan.lobed_paths.empty()) return;
  std::vector<int64_t> indices;
  for (const SharedLegPlan::PlannedPath& path : plan.lobed_paths) indices.push_back(path.path);
  const LocalPaths local = preparer(indices);
  PathLobes lobes(preparer);
  for (size_t node = 0; node < nodes.size(); ++node) {
    const PosedScene& scene = nodes.at(node);
    const size_t num_receivers = scene.receivers.size();
    for (size_t i = 0; i < indices.size(); ++i) {
      lobes.pose(local.paths[i], scene);
      for (size_t channel = 0; channel < channels.nodes.size(); ++channel) {
        const size_t of_all = channels.first + channel;
        channels.nodes[channel].scale_amplitude(node, plan.lobed_paths[i].place,
                                                lobes.factor(of_all / num_receivers, of_all % num_receivers));
      }
    }
  }
}

}  // namespace echopath
