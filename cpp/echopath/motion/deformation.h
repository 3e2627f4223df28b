#pragma once
// Deformation of a mesh: time -> vertices.
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
  // Vertices [V] in m at `time` (s); raises invalid_argument outside span().
  virtual std::vector<Vec3> at(double time) const = 0;
  // Vertices `indices` [I] only, at the cost of these; out [I]. Raises invalid_argument for an index beyond V.
  virtual void at(double time, const std::vector<uint32_t>& indices, std::vector<Vec3>& out) const = 0;
  // Times (s) where it is not smooth, ascending, ends of the span excluded.
  virtual std::vector<double> breakpoints() const = 0;
  virtual TimeSpan span() const = 0;
  // As Motion::turn_rate, of all vertices.
  virtual double turn_rate(const TimeSpan& during) const = 0;
};

// Sampled vertices: T frames of V vertices each, [T][V] in m. Interpolation as in KeyframeMotion; cubic ones keep the
// second derivatives too, so they take twice the memory of their frames.
class VertexSequence : public Deformation {
 public:
  VertexSequence(std::vector<double> times, std::vector<std::vector<Vec3>> vertices,
                 Interpolation interpolation = Interpolation::kCubic);
  ~VertexSequence() override;
  int64_t num_vertices() const override;
  std::vector<Vec3> at(double time) const override;
  void at(double time, const std::vector<uint32_t>& indices, std::vector<Vec3>& out) const override;
  std::vector<double> breakpoints() const override;
  TimeSpan span() const override;
  double turn_rate(const TimeSpan& during) const override;
  const std::vector<double>& times() const;
  const std::vector<std::vector<Vec3>>& vertices() const;
  Interpolation interpolation() const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

}  // namespace echopath
