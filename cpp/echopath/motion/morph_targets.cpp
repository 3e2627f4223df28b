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

struct MorphTargets::Data {
  std::vector<Vec3> vertices;
  std::vector<std::vector<Vec3>> targets;
  std::vector<double> extents;  // [K] m
  Curve weights;
  Playback playback;
  bool rests;

  std::vector<double> shares(double time) const {
    std::vector<double> shares(targets.size());
    evaluate(weights, playback, rests ? time_at_rest(time) : time, shares);
    return shares;
  }

  Vec3 vertex(const std::vector<double>& shares, size_t i) const {
    Vec3 sum = vertices[i];
    for (size_t k = 0; k < shares.size(); ++k) {
      if (shares[k] != 0.0) sum += shares[k] * targets[k][i];
    }
    return sum;
  }
};

MorphTargets::MorphTargets(std::vector<Vec3> vertices, std::vector<std::vector<Vec3>> targets, Curve weights,
                           const Playback& playback) {
  require(!vertices.empty(), "vertices", "must hold at least one vertex", 0);
  check_points(vertices, "vertices");
  require(!targets.empty(), "targets", "must hold at least one target", 0);
  for (const std::vector<Vec3>& target : targets) {
    require(target.size() == vertices.size(), "targets", "must have a displacement for each vertex", target.size());
    check_points(target, "targets");
  }
  weights.validate("weights", targets.size());
  playback.validate();
  std::vector<double> extents = extents_of(targets);
  const bool rests = weights.is_constant();
  data_ = std::make_shared<const Data>(
      Data{std::move(vertices), std::move(targets), std::move(extents), std::move(weights), playback, rests});
}

MorphTargets::~MorphTargets() = default;

int64_t MorphTargets::num_vertices() const { return std::ssize(data_->vertices); }

std::vector<Vec3> MorphTargets::at(double time) const {
  const std::vector<double> shares = data_->shares(time);
  std::vector<Vec3> out(data_->vertices.size());
  for (size_t i = 0; i < out.size(); ++i) out[i] = data_->vertex(shares, i);
  return out;
}

void MorphTargets::at(double time, const std::vector<uint32_t>& indices, std::vector<Vec3>& out) const {
  const std::vector<double> shares = data_->shares(time);
  out.resize(indices.size());
  for (size_t i = 0; i < indices.size(); ++i) {
    require(indices[i] < data_->vertices.size(), "indices", "must be below the number of vertices", indices[i]);
    out[i] = data_->vertex(shares, indices[i]);
  }
}

std::vector<double> MorphTargets::breakpoints(const TimeSpan& during) const {
  std::vector<double> times;
  data_->playback.append_times(data_->weights.times, during, times);
  return times;
}

bool MorphTargets::rests() const { return data_->rests; }

double MorphTargets::turn_rate(const TimeSpan& during) const {
  return curve_turn_rate(data_->weights, data_->playback, during, data_->extents);
}

const std::vector<Vec3>& MorphTargets::vertices() const { return data_->vertices; }
const std::vector<std::vector<Vec3>>& MorphTargets::targets() const { return data_->targets; }
const Curve& MorphTargets::weights() const { return data_->weights; }
const Playback& MorphTargets::playback() const { return data_->playback; }

}  // namespace echopath
