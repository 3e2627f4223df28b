#include "echopath/motion/morph_targets.h"

#include <algorithm>
#include <utility>

#include "echopath/base/errors.h"

namespace echopath {
namespace {

void check_points(const std::vector<Vec3>& points, const char* argument) {
  for (const Vec3& point : points) require(point.allFinite(), argument, "must be finite", point.transpose());
}

// Returns the longest displacement of each target, m.
std::vector<double> extents_of(const std::vector<std::vector<Vec3>>& targets) {
  std::vector<double> extents;
  for (const std::vector<Vec3>& target : targets) {
    double longest = 0.0;
    for (const Vec3& displacement : target) longest = std::max(longest, displacement.norm());
    extents.push_back(longest);
  }
  return extents;
}

}  // namespace

MorphTargets::MorphTargets(std::vector<Vec3> vertices, std::vector<std::vector<Vec3>> targets, Curve weights,
                           const Playback& playback)
    : vertices_(std::move(vertices)), targets_(std::move(targets)), weights_(std::move(weights)), playback_(playback) {
  require(!vertices_.empty(), "vertices", "must hold at least one vertex", 0);
  check_points(vertices_, "vertices");
  require(!targets_.empty(), "targets", "must hold at least one target", 0);
  for (const std::vector<Vec3>& target : targets_) {
    require(target.size() == vertices_.size(), "targets", "must have a displacement for each vertex", target.size());
    check_points(target, "targets");
  }
  weights_.validate("weights", targets_.size());
  playback.validate();
  extents_ = extents_of(targets_);
  rests_ = weights_.is_constant();
}

std::vector<double> MorphTargets::shares(double time) const {
  std::vector<double> shares(targets_.size());
  evaluate(weights_, playback_, rests_ ? time_at_rest(time) : time, shares);
  return shares;
}

Vec3 MorphTargets::vertex(const std::vector<double>& shares, size_t i) const {
  Vec3 sum = vertices_[i];
  for (size_t k = 0; k < shares.size(); ++k) {
    if (shares[k] != 0.0) sum += shares[k] * targets_[k][i];
  }
  return sum;
}

std::vector<Vec3> MorphTargets::at(double time) const {
  const std::vector<double> now = shares(time);
  std::vector<Vec3> out(vertices_.size());
  for (size_t i = 0; i < out.size(); ++i) out[i] = vertex(now, i);
  return out;
}

void MorphTargets::at(double time, const std::vector<uint32_t>& indices, std::vector<Vec3>& out) const {
  const std::vector<double> now = shares(time);
  out.resize(indices.size());
  for (size_t i = 0; i < indices.size(); ++i) {
    require(indices[i] < vertices_.size(), "indices", "must be below the number of vertices", indices[i]);
    out[i] = vertex(now, indices[i]);
  }
}

std::vector<double> MorphTargets::breakpoints(const TimeSpan& during) const {
  std::vector<double> times;
  playback_.append_times(weights_.times, during, times);
  return times;
}

double MorphTargets::turn_rate(const TimeSpan& during) const {
  return curve_turn_rate(weights_, playback_, during, extents_);
}

}  // namespace echopath
