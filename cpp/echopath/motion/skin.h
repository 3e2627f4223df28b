#pragma once
// Linear blend skinning: the vertices of one mesh follow the joints of a skeleton.
#include <array>
#include <optional>
#include <span>
#include <string>

#include "echopath/motion/deformation.h"

namespace echopath {

// A joint moves as a node does (see `moved`): skin_from_joint(t) = skin_from_parent(t) * moved(placement, motion, t).
struct Joint {
  std::string name;                               // unique within its skin
  int parent = -1;                                // index of an earlier joint, -1: moves in the frame of the skin
  Transform placement = Transform::Identity();    // at rest, relative to the parent
  std::shared_ptr<const Motion> motion;           // may be null
  // Frame of the skin -> frame of the joint, where the vertices were bound to it. None: as the joints stand at rest.
  std::optional<Transform> inverse_bind;
};

// Which joints a vertex follows, and how much: row-major [V, per_vertex]. Entries of weight 0 count as not there.
struct SkinWeights {
  int64_t per_vertex = 0;
  std::vector<uint32_t> joint;
  std::vector<double> weight;  // >= 0, the sum over each row is 1
};

// v(t) = sum_j weight_j * skin_from_joint_j(t) * inverse_bind_j * v, exact at every time (Magnenat-Thalmann, Laperriere,
// Thalmann 1988, "Joint-dependent local deformations"). Away from rigid weights the surface narrows where joints twist,
// as that method does. Poses only what it is asked for. Immutable.
class Skin : public Deformation {
 public:
  // vertices [V] in m as bound, in the frame of the skin. Any number of joints per vertex; rows whose sum is off 1 by less
  // than 1e-4 are scaled. Raises invalid_argument naming the argument.
  Skin(std::vector<Vec3> vertices, std::vector<Joint> joints, const SkinWeights& weights);
  ~Skin() override;

  int64_t num_vertices() const override;
  std::vector<Vec3> at(double time) const override;
  void at(double time, const std::vector<uint32_t>& indices, std::vector<Vec3>& out) const override;
  std::vector<double> breakpoints() const override;  // of all joints
  TimeSpan span() const override;                    // common to all joints; empty (begin > end) where there is none
  double turn_rate(const TimeSpan& during) const override;  // of the fastest joint, those above it added

  const std::vector<Vec3>& vertices() const;
  const std::vector<Joint>& joints() const;  // all with inverse_bind
  SkinWeights weights() const;               // rows filled up with joint 0, weight 0

  // skin_from_joint(t) * inverse_bind [J]: what moves the vertices that follow one joint alone.
  std::vector<Transform> joint_transforms(double time) const;
  // Joint [F] of the largest summed weight over the corners of each triangle (indices of vertices), the first of equals.
  std::vector<uint32_t> dominant_joint(std::span<const std::array<uint32_t, 3>> triangles) const;

 private:
  struct Data;
  std::shared_ptr<const Data> data_;
};

}  // namespace echopath
