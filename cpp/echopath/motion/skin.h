#pragma once
// Deforms a mesh by linear blend skinning: its vertices follow the joints of a skeleton.
#include <array>
#include <optional>
#include <span>
#include <string>

#include "echopath/motion/deformation.h"

namespace echopath {

// A joint moves as a node does (see `moved`): skin_from_joint(t) = skin_from_parent(t) * moved(placement, motion, t).
struct Joint {
  std::string name;                             // unique within its skin
  int parent = -1;                              // index of an earlier joint, -1: moves in the frame of the skin
  Transform placement = Transform::Identity();  // at rest, relative to the parent
  std::shared_ptr<const Motion> motion;         // may be null
  // Takes the frame of the skin to that of the joint, as the vertices were bound to it. None means the joints' placements at
  // rest.
  std::optional<Transform> inverse_bind;
};

// Tells in rows [V, per_vertex] which joints a vertex follows, and with what weight. Entries of weight 0 are ignored.
struct SkinWeights {
  int64_t per_vertex = 0;
  std::vector<uint32_t> joint;
  std::vector<double> weight;  // >= 0, the sum over each row is 1
};

// Computes v(t) = sum_j weight_j * skin_from_joint_j(t) * inverse_bind_j * v, exactly at every time (Magnenat-Thalmann,
// Laperriere, Thalmann 1988, "Joint-dependent local deformations"). Where a vertex follows several joints, the surface
// narrows where these turn, as is known of the method. It poses only the vertices it is asked for. Where it has a shape, v
// is that of the shape at the same time. Immutable.
class Skin : public Deformation {
 public:
  // vertices [V] in m as bound, in the frame of the skin. A vertex may follow any number of joints; rows whose sum is off 1
  // by less than 1e-4 are scaled. Raises invalid_argument naming the argument.
  // `shape` replaces the vertices at each time, before the joints move them; null: they stay. It must have V vertices.
  Skin(std::vector<Vec3> vertices, std::vector<Joint> joints, const SkinWeights& weights,
       std::shared_ptr<const Deformation> shape = nullptr);

  int64_t num_vertices() const override;
  std::vector<Vec3> at(double time) const override;
  void at(double time, const std::vector<uint32_t>& indices, std::vector<Vec3>& out) const override;
  std::vector<double> breakpoints(const TimeSpan& during = {}) const override;  // of all joints and of the shape
  TimeSpan span() const override;                           // common to all of them; begin > end where there is none
  bool rests() const override;                              // all joints and the shape do
  double turn_rate(const TimeSpan& during) const override;  // of the fastest joint, those above it and the shape added

  const std::vector<Vec3>& vertices() const;
  const std::vector<Joint>& joints() const;  // all with inverse_bind
  const std::shared_ptr<const Deformation>& shape() const;
  SkinWeights weights() const;  // rows are padded with joint 0, weight 0

  // Returns skin_from_joint(t) * inverse_bind [J], which moves the vertices that follow one joint alone.
  std::vector<Transform> joint_transforms(double time) const;
  // Returns for each triangle [F] (indices of vertices) the joint of the largest weight, summed over its corners; the first
  // of equals.
  std::vector<uint32_t> dominant_joint(std::span<const std::array<uint32_t, 3>> triangles) const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

}  // namespace echopath
