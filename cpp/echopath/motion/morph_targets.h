#pragma once
// Deforms a mesh by morph targets: it takes on shares of other shapes.
#include "echopath/motion/curve.h"
#include "echopath/motion/deformation.h"

namespace echopath {

// Computes v(t) = base + sum_k weight_k(t) * target_k, with targets that are displacements. Exact at every time; defined at
// all of them, with breakpoints as CurveMotion has them. It computes only the vertices it is asked for. Immutable.
class MorphTargets : public Deformation {
 public:
  // vertices [V] in m; targets [K][V] in m; weights: a curve of K columns. Raises invalid_argument naming the argument.
  MorphTargets(std::vector<Vec3> vertices, std::vector<std::vector<Vec3>> targets, Curve weights,
               const Playback& playback = {});
  int64_t num_vertices() const override { return std::ssize(vertices_); }
  std::vector<Vec3> at(double time) const override;
  void at(double time, const std::vector<uint32_t>& indices, std::vector<Vec3>& out) const override;
  std::vector<double> breakpoints(const TimeSpan& during = {}) const override;
  TimeSpan span() const override { return {}; }
  bool rests() const override { return rests_; }  // all weights are constant
  double turn_rate(const TimeSpan& during) const override;
  const std::vector<Vec3>& vertices() const { return vertices_; }
  const std::vector<std::vector<Vec3>>& targets() const { return targets_; }
  const Curve& weights() const { return weights_; }
  const Playback& playback() const { return playback_; }

 private:
  std::vector<double> shares(double time) const;
  Vec3 vertex(const std::vector<double>& shares, size_t i) const;

  std::vector<Vec3> vertices_;
  std::vector<std::vector<Vec3>> targets_;
  std::vector<double> extents_;  // [K] m
  Curve weights_;
  Playback playback_;
  bool rests_;
};

}  // namespace echopath
