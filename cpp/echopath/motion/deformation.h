#pragma once
// A deformation maps time to the vertices of a mesh.
#include <cstdint>
#include <memory>
#include <vector>

#include "echopath/motion/motion.h"

namespace echopath {

// Replaces the vertices of the mesh of its node, in the node's own frame and in the order [V] of the vertices that the
// mesh was made from.
class Deformation {
 public:
  virtual ~Deformation() = default;
  virtual int64_t num_vertices() const = 0;
  // Returns the vertices [V] in m at `time` (s); raises invalid_argument outside span().
  virtual std::vector<Vec3> at(double time) const = 0;
  // Writes only the vertices `indices` [I] to out [I], at the cost of these. Raises invalid_argument for an index beyond V.
  virtual void at(double time, const std::vector<uint32_t>& indices, std::vector<Vec3>& out) const = 0;
  // Returns the times (s) where the deformation is not smooth, as Motion::breakpoints does.
  virtual std::vector<double> breakpoints(const TimeSpan& during = {}) const = 0;
  virtual TimeSpan span() const = 0;
  // Tells whether at(t) has the same bits at all times of the span, as Motion::rests does.
  virtual bool rests() const { return false; }
  // Returns the bound of Motion::turn_rate for the fastest vertex, rad/s.
  virtual double turn_rate(const TimeSpan& during) const = 0;
};

// Interpolates sampled vertices, T frames of V vertices each, [T][V] in m, as KeyframeMotion does. Cubic interpolation keeps
// the second derivatives too, so it takes twice the memory of the frames.
class VertexSequence : public Deformation {
 public:
  VertexSequence(std::vector<double> times, std::vector<std::vector<Vec3>> vertices,
                 Interpolation interpolation = Interpolation::kCubic);
  int64_t num_vertices() const override;
  std::vector<Vec3> at(double time) const override;
  void at(double time, const std::vector<uint32_t>& indices, std::vector<Vec3>& out) const override;
  std::vector<double> breakpoints(const TimeSpan& during = {}) const override;
  TimeSpan span() const override;
  bool rests() const override;  // all frames are equal
  double turn_rate(const TimeSpan& during) const override;
  const std::vector<double>& times() const;
  const std::vector<std::vector<Vec3>>& vertices() const;
  Interpolation interpolation() const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

// Returns whether a deformation moves anything. A null one does not.
inline bool moves(const std::shared_ptr<const Deformation>& deformation) { return deformation && !deformation->rests(); }

}  // namespace echopath
