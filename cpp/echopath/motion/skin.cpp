#include "echopath/motion/skin.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "echopath/base/errors.h"

namespace echopath {
namespace {

// A sum of weights farther from 1 than this is a mistake; files keep weights in single precision.
constexpr double kSumTolerance = 1e-4;
// A sum nearer to 1 than this is left alone, so that saved weights keep their bits.
constexpr double kSumRounding = 1e-13;

void check_joint(const Joint& joint, size_t index, std::set<std::string>& names) {
  require(!joint.name.empty(), "joints", "must have names; joint", index);
  require(names.insert(joint.name).second, "joints", "must have names of their own", "'" + joint.name + "' twice");
  require(joint.parent >= -1 && joint.parent < static_cast<int>(index), "joints",
          "must stand behind their parents; parent of '" + joint.name + "'", joint.parent);
  require(joint.placement.matrix().allFinite() && joint.placement.linear().determinant() != 0.0, "joints",
          "must have a finite placement that does not flatten space", "that of '" + joint.name + "'");
  require(!joint.inverse_bind || joint.inverse_bind->matrix().allFinite(), "joints", "must have a finite inverse_bind",
          "that of '" + joint.name + "'");
}

// Fills in inverse_bind where it is not given.
std::vector<Joint> bound(std::vector<Joint> joints) {
  require(!joints.empty(), "joints", "must hold at least one joint", 0);
  std::set<std::string> names;
  std::vector<Transform> skin_from_joint;
  for (size_t j = 0; j < joints.size(); ++j) {
    Joint& joint = joints[j];
    check_joint(joint, j, names);
    skin_from_joint.push_back(joint.parent < 0 ? joint.placement : skin_from_joint[joint.parent] * joint.placement);
    if (!joint.inverse_bind) joint.inverse_bind = skin_from_joint.back().inverse();
  }
  return joints;
}

void check_shapes(const std::vector<Vec3>& vertices, const SkinWeights& weights) {
  require(!vertices.empty(), "vertices", "must hold at least one vertex", 0);
  for (const Vec3& vertex : vertices) require(vertex.allFinite(), "vertices", "must be finite", vertex.transpose());
  require(weights.per_vertex >= 1, "weights", "must have at least one column", weights.per_vertex);
  const size_t count = vertices.size() * static_cast<size_t>(weights.per_vertex);
  require(weights.weight.size() == count, "weights", "must have a row for each vertex; numbers", weights.weight.size());
  require(weights.joint.size() == count, "joint_indices", "must have the shape of weights; numbers", weights.joint.size());
}

}  // namespace

struct Skin::Data {
  struct Influence {
    uint32_t joint;
    double weight;
  };
  std::vector<Vec3> vertices;
  std::vector<Joint> joints;
  std::shared_ptr<const Deformation> shape;  // may be null
  std::vector<uint32_t> first;               // [V + 1] into influences
  std::vector<Influence> influences;         // by vertex

  void add_row(const SkinWeights& weights, size_t vertex);
  Vec3 moved_vertex(const std::vector<Transform>& transforms, size_t index, const Vec3& from) const;
  int64_t longest_row() const;
};

void Skin::Data::add_row(const SkinWeights& weights, size_t vertex) {
  const size_t begin = vertex * static_cast<size_t>(weights.per_vertex);
  double sum = 0.0;
  for (size_t i = begin; i < begin + static_cast<size_t>(weights.per_vertex); ++i) {
    const double weight = weights.weight[i];
    require(std::isfinite(weight) && weight >= 0.0, "weights", "must be finite and >= 0", weight);
    if (weight == 0.0) continue;
    require(weights.joint[i] < joints.size(), "joint_indices", "must be below the number of joints", weights.joint[i]);
    influences.push_back({weights.joint[i], weight});
    sum += weight;
  }
  if (!(std::abs(sum - 1.0) <= kSumTolerance))
    require(false, "weights", "must add up to 1 for vertex " + std::to_string(vertex), sum);
  if (std::abs(sum - 1.0) > kSumRounding) {
    for (size_t i = first.back(); i < influences.size(); ++i) influences[i].weight /= sum;
  }
  first.push_back(static_cast<uint32_t>(influences.size()));
}

Vec3 Skin::Data::moved_vertex(const std::vector<Transform>& transforms, size_t index, const Vec3& from) const {
  Vec3 sum = Vec3::Zero();
  for (uint32_t i = first[index]; i < first[index + 1]; ++i) {
    sum += influences[i].weight * (transforms[influences[i].joint] * from);
  }
  return sum;
}

int64_t Skin::Data::longest_row() const {
  uint32_t longest = 1;
  for (size_t v = 0; v < vertices.size(); ++v) longest = std::max(longest, first[v + 1] - first[v]);
  return longest;
}

Skin::Skin(std::vector<Vec3> vertices, std::vector<Joint> joints, const SkinWeights& weights,
           std::shared_ptr<const Deformation> shape) {
  check_shapes(vertices, weights);
  const auto num_vertices = std::ssize(vertices);
  require(!shape || shape->num_vertices() == num_vertices, "shape", "must have as many vertices as the skin",
          shape ? shape->num_vertices() : 0);
  require(!dynamic_cast<const Skin*>(shape.get()), "shape", "must not be a skin itself", "one");
  Data data{std::move(vertices), bound(std::move(joints)), std::move(shape), {0}, {}};
  data.first.reserve(data.vertices.size() + 1);
  for (size_t v = 0; v < data.vertices.size(); ++v) data.add_row(weights, v);
  data_ = std::make_shared<const Data>(std::move(data));
}

int64_t Skin::num_vertices() const { return std::ssize(data_->vertices); }
const std::vector<Vec3>& Skin::vertices() const { return data_->vertices; }
const std::vector<Joint>& Skin::joints() const { return data_->joints; }
const std::shared_ptr<const Deformation>& Skin::shape() const { return data_->shape; }

std::vector<Transform> Skin::joint_transforms(double time) const {
  std::vector<Transform> transforms;  // skin_from_joint at first, because children need it
  transforms.reserve(data_->joints.size());
  for (const Joint& joint : data_->joints) {
    const Transform local = moved(joint.placement, joint.motion.get(), time);
    transforms.push_back(joint.parent < 0 ? local : transforms[joint.parent] * local);
  }
  for (size_t j = 0; j < transforms.size(); ++j) transforms[j] = transforms[j] * *data_->joints[j].inverse_bind;
  return transforms;
}

std::vector<Vec3> Skin::at(double time) const {
  const std::vector<Transform> transforms = joint_transforms(time);
  std::vector<Vec3> out = data_->shape ? data_->shape->at(time) : data_->vertices;
  for (size_t i = 0; i < out.size(); ++i) out[i] = data_->moved_vertex(transforms, i, out[i]);
  return out;
}

void Skin::at(double time, const std::vector<uint32_t>& indices, std::vector<Vec3>& out) const {
  const std::vector<Transform> transforms = joint_transforms(time);
  if (data_->shape) data_->shape->at(time, indices, out);
  out.resize(indices.size());
  for (size_t i = 0; i < indices.size(); ++i) {
    require(indices[i] < data_->vertices.size(), "indices", "must be below the number of vertices", indices[i]);
    const Vec3 from = data_->shape ? out[i] : data_->vertices[indices[i]];
    out[i] = data_->moved_vertex(transforms, indices[i], from);
  }
}

std::vector<double> Skin::breakpoints(const TimeSpan& during) const {
  std::set<double> times;
  const auto add = [&](const std::vector<double>& own) { times.insert(own.begin(), own.end()); };
  for (const Joint& joint : data_->joints) {
    if (joint.motion) add(joint.motion->breakpoints(during));
  }
  if (data_->shape) add(data_->shape->breakpoints(during));
  return {times.begin(), times.end()};
}

TimeSpan Skin::span() const {
  TimeSpan common;
  const auto cut = [&](const TimeSpan& own) { common = {std::max(common.begin, own.begin), std::min(common.end, own.end)}; };
  for (const Joint& joint : data_->joints) {
    if (joint.motion) cut(joint.motion->span());
  }
  if (data_->shape) cut(data_->shape->span());
  return common;
}

bool Skin::rests() const {
  const auto stays = [](const Joint& joint) { return !moves(joint.motion); };
  return std::ranges::all_of(data_->joints, stays) && !moves(data_->shape);
}

double Skin::turn_rate(const TimeSpan& during) const {
  std::vector<double> rates;  // by joint
  double fastest = 0.0;
  for (const Joint& joint : data_->joints) {
    const double above = joint.parent < 0 ? 0.0 : rates[joint.parent];
    rates.push_back(above + (joint.motion ? joint.motion->turn_rate(during) : 0.0));
    fastest = std::max(fastest, rates.back());
  }
  return fastest + (data_->shape ? data_->shape->turn_rate(during) : 0.0);
}

SkinWeights Skin::weights() const {
  SkinWeights out;
  out.per_vertex = data_->longest_row();
  const size_t columns = static_cast<size_t>(out.per_vertex), count = data_->vertices.size() * columns;
  out.joint.assign(count, 0);
  out.weight.assign(count, 0.0);
  for (size_t v = 0; v < data_->vertices.size(); ++v) {
    for (uint32_t i = data_->first[v]; i < data_->first[v + 1]; ++i) {
      const size_t at = v * columns + (i - data_->first[v]);
      out.joint[at] = data_->influences[i].joint;
      out.weight[at] = data_->influences[i].weight;
    }
  }
  return out;
}

std::vector<uint32_t> Skin::dominant_joint(std::span<const std::array<uint32_t, 3>> triangles) const {
  std::vector<uint32_t> dominant;
  dominant.reserve(triangles.size());
  std::vector<double> sums(data_->joints.size(), 0.0);
  for (const std::array<uint32_t, 3>& triangle : triangles) {
    std::ranges::fill(sums, 0.0);
    for (const uint32_t vertex : triangle) {
      require(vertex < data_->vertices.size(), "triangles", "must hold indices below the number of vertices", vertex);
      for (uint32_t i = data_->first[vertex]; i < data_->first[vertex + 1]; ++i) {
        sums[data_->influences[i].joint] += data_->influences[i].weight;
      }
    }
    dominant.push_back(static_cast<uint32_t>(std::ranges::max_element(sums) - sums.begin()));
  }
  return dominant;
}

}  // namespace echopath
