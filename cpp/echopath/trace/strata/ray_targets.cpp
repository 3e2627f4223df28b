#include "echopath/trace/strata/ray_targets.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "echopath/base/threads/parallel.h"
#include "echopath/trace/strata/ray_target_finder.h"

namespace echopath {
namespace {

// Largest number of targets: with the field of view they stay below kNoStratum.
constexpr size_t kMaxAims = 65000;
// Largest number of things of one object, and of their images: more would have too few rays each.
constexpr size_t kMostThings = 256;
constexpr int kLooks = 64;  // at a thing, until it is taken to be hidden
static_assert(kLooks % kPacketSize == 0);
// Share of the stratum of an object that the strata of its parts fill, above which they are not aimed at one by one.
constexpr double kMostlyFilled = 0.5;

bool has_fewer_mirrors(const RayTarget& a, const RayTarget& b) { return a.stratum.num_mirrors < b.stratum.num_mirrors; }

// Marks the meshes of objects that stand still [mesh ID]; mirrors are no objects.
std::vector<bool> still_objects(std::vector<bool> still_meshes, const Scene& scene) {
  for (uint32_t id = 0; id < still_meshes.size(); ++id)
    if (scene.node_of(id).material->mirror) still_meshes[id] = false;
  return still_meshes;
}

// Finds the targets of one object after the other, and at the end the images of whole objects, side by side.
class TargetSearch {
 public:
  TargetSearch(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
               const RayTargetSettings& settings, RayTargets& out)
      : scene_(scene), geometry_(geometry), settings_(settings), finder_(scene, mirrors, settings),
        is_still_(scene.still_meshes()), holds_still_(scene.nodes_above(still_objects(is_still_, scene))), out_(out) {}

  void take(const SceneObject& object) {
    heed_cancelling();
    SceneObject still{object.node, {}}, rest{object.node, {}};
    for (const uint32_t id : object.mesh_ids) (is_still_[id] ? still : rest).mesh_ids.push_back(id);
    if (!settings_.is_steady || still.mesh_ids.empty() || rest.mesh_ids.empty()) return take_as_one(object);
    take_as_one(still);
    take_apart(rest);
  }

  void finish() {
    std::vector<RayTarget> images = all_images();
    limit(images);
    out_.targets = std::move(objects_);
    append(std::move(images), out_.targets);
  }

 private:
  struct Thing {
    TargetMeshes target;
    RayTarget direct;
    double echo;  // 1/m^2: grows with the echo, as the square of its size over the square of its distance
  };
  // Holds an object that is one target, and the place of its images among those of others.
  struct Whole {
    TargetMeshes target;
    size_t place;
  };

  void heed_cancelling() const {
    if (settings_.job) settings_.job->throw_if_cancelled();
  }

  static void append(std::vector<RayTarget> more, std::vector<RayTarget>& to) {
    std::move(more.begin(), more.end(), std::back_inserter(to));
  }

  // Aims at an object and its images, or else at the things that it consists of.
  void take_as_one(const SceneObject& object) {
    TargetMeshes target = new_target(object);
    std::optional<RayTarget> direct = finder_.at_object(target);
    std::vector<Thing> things;
    const std::vector<SceneObject> parts = parts_below(object);
    if (!direct || are_apart(parts)) find_things(parts, things);
    if (direct && (things.empty() || solid_angle_of(things) > kMostlyFilled * direct->stratum.solid_angle())) {
      own(object, target.object);
      objects_.push_back(std::move(*direct));
      target.forget_vertices();
      wholes_.push_back({std::move(target), images_.size()});
      images_.emplace_back();
    } else {
      if (!direct) leave_to_field_of_view(target);
      take_still_and_moving(things);
    }
  }

  // Aims at the highest nodes below which nothing stands still.
  void take_apart(const SceneObject& object) {
    MeshesByNode found;
    for (const uint32_t id : object.mesh_ids) {
      int node = scene_.meshes()[id].node;
      while (!holds_still_[scene_.nodes()[node].parent]) node = scene_.nodes()[node].parent;
      found.add(node, id);
    }
    std::vector<Thing> things;
    if (may_look_at(found.found())) look_at(found.found(), things);
    else leave_to_field_of_view(new_target(object));
    take_strongest(things);
  }

  TargetMeshes new_target(const SceneObject& object) {
    const int index = out_.num_objects++;
    own(object, index);
    const bool moves = !std::ranges::all_of(object.mesh_ids, [&](uint32_t id) { return is_still_[id]; });
    return TargetMeshes(scene_, geometry_, object, index, moves);
  }

  void leave_to_field_of_view(const TargetMeshes& target) {
    out_.any_unaimed = true;
    out_.any_still_unaimed = out_.any_still_unaimed || !target.moves;
  }

  void own(const SceneObject& object, int index) {
    for (const uint32_t id : object.mesh_ids) out_.object_of_mesh[id] = index;
  }

  static double solid_angle_of(const std::vector<Thing>& things) {  // sr, the sum
    return std::accumulate(things.begin(), things.end(), 0.0,
                           [](double sum, const Thing& thing) { return sum + thing.direct.stratum.solid_angle(); });
  }

  double distance_of(const Sphere& sphere) const { return (sphere.centre - settings_.transmitter).norm(); }

  // Returns whether most parts are farther from all others, by their boxes, than half their own length. Posts of a guard
  // rail are not: they carry it.
  bool are_apart(const std::vector<SceneObject>& parts) const {
    if (parts.size() < 2 || parts.size() > kMostThings) return false;
    std::vector<Box> boxes(parts.size());
    for (size_t i = 0; i < parts.size(); ++i) {
      for (const uint32_t id : parts[i].mesh_ids) boxes[i].extend(geometry_.box(id));
    }
    const auto num_apart = std::ranges::count_if(boxes, [&](const Box& box) {
      const double near = 0.5 * box.diagonal().norm();
      return std::ranges::none_of(boxes,
                                  [&](const Box& other) { return &other != &box && other.exteriorDistance(box) <= near; });
    });
    return 2 * num_apart >= std::ssize(parts);
  }

  // Returns the parts of an object, or those of its part where there is but one: of nodes one below the other.
  std::vector<SceneObject> parts_below(const SceneObject& object) const {
    std::vector<SceneObject> parts = parts_of(scene_, object);
    for (int node = object.node; parts.size() == 1 && parts.front().node != node;) {
      node = parts.front().node;
      parts = parts_of(scene_, parts.front());
    }
    return parts;
  }

  bool may_look_at(const std::vector<SceneObject>& parts) const {
    return out_.num_objects + std::ssize(parts) <= settings_.most_objects;
  }

  // Finds among the parts of an object, and theirs in turn, the largest that a stratum holds.
  void find_things(const std::vector<SceneObject>& parts, std::vector<Thing>& things) {
    if (parts.size() > 1 && may_look_at(parts)) look_at(parts, things);
  }

  void look_at(const std::vector<SceneObject>& parts, std::vector<Thing>& things) {
    for (const SceneObject& part : parts) {
      heed_cancelling();
      TargetMeshes target = new_target(part);
      std::optional<RayTarget> direct = finder_.at_object(target);
      if (direct) {
        const double distance = distance_of(target.sphere);
        const double echo = std::pow(target.sphere.radius / (distance * distance), 2);
        things.push_back({std::move(target), std::move(*direct), echo});
      } else {
        leave_to_field_of_view(target);
        find_things(parts_below(part), things);
      }
    }
  }

  // Returns whether a ray from the transmitter whose first hit is `met` meets something else before the target, within
  // `reach` (m). What moves does not hide what is to have the same rays in all frames.
  bool is_hidden(const TargetMeshes& target, const Vec3& direction, double reach, RayHit met) const {
    const bool passes_what_moves = settings_.is_steady && !target.moves;
    auto verdict = EmbreeScene::Verdict::kHit;
    while (verdict == EmbreeScene::Verdict::kHit && met.distance < reach) {
      if (!passes_what_moves || is_still_[met.hit.mesh_id]) return out_.object_of_mesh[met.hit.mesh_id] != target.object;
      const double begin = geometry_.behind(met.distance, met.reported);
      verdict = geometry_.intersect_from_surface(settings_.transmitter, direction, met, Sees::kOpaque, begin);
    }
    return false;
  }

  // Returns whether a ray to any of kLooks vertices, evenly taken of all, meets the target or what lies behind it.
  bool is_in_sight(TargetMeshes& target) const {
    heed_cancelling();
    const std::vector<Vec3>& vertices = target.vertices();
    for (int first = 0; first < kLooks; first += kPacketSize) {
      LaneVectors directions;
      LaneValues reach;
      for (int lane = 0; lane < kPacketSize; ++lane) {
        const size_t at =
            vertices.size() * static_cast<size_t>(lane * (kLooks / kPacketSize) + first / kPacketSize) / kLooks;
        const Vec3 there = vertices[at] - settings_.transmitter;
        reach[lane] = there.norm();
        directions.set(lane, unpacked(reach[lane] > 0.0 ? Vec3(there / reach[lane]) : Vec3(Vec3::UnitX())));
      }
      EmbreeScene::PacketHits hits;
      geometry_.intersect(settings_.transmitter, directions, kPacketSize, hits);
      for (int lane = 0; lane < kPacketSize; ++lane) {
        const bool meets_any = hits.verdicts[lane] == EmbreeScene::Verdict::kHit;
        if (!meets_any || !is_hidden(target, packed(directions.at(lane)), reach[lane], hits[lane])) return true;
      }
    }
    return false;
  }

  // What moves takes no place, and no part of the weight, from what stands still: both are the same in all frames.
  void take_still_and_moving(std::vector<Thing>& things) {
    std::vector<Thing> still, moving;
    for (Thing& thing : things) (thing.target.moves ? moving : still).push_back(std::move(thing));
    take_strongest(still);
    take_strongest(moving);
  }

  // Of too many things, those that are in sight and have the strongest echoes get rays of their own.
  void take_strongest(std::vector<Thing>& things) {
    if (things.size() > kMostThings) {
      std::erase_if(things, [&](Thing& thing) { return !is_in_sight(thing.target); });
      std::ranges::stable_sort(things, std::greater(), &Thing::echo);
    }
    const size_t kept = std::min(things.size(), kMostThings);
    leave_out(things.size() - kept);
    things.erase(things.begin() + static_cast<int64_t>(kept), things.end());
    aim_at(things);
  }

  // Returns the images of all targets, of one after the other. Those of whole objects, which are most of the work, are
  // looked for here, side by side.
  std::vector<RayTarget> all_images() {
    parallel_for(std::ssize(wholes_), [&](int64_t i) {
      heed_cancelling();
      auto& [target, place] = wholes_[i];
      for (int n = 1; n <= finder_.most_mirrors(); ++n) finder_.add_images(target, n, images_[place]);
      target.forget_vertices();
    });
    std::vector<RayTarget> images;
    for (std::vector<RayTarget>& of_target : images_) append(std::move(of_target), images);
    return images;
  }

  // Leaves out the images over the most mirrors first, then the objects that fill the least of the view.
  void limit(std::vector<RayTarget>& images) {
    const size_t all = objects_.size() + images.size();
    std::ranges::stable_sort(images, has_fewer_mirrors);
    if (objects_.size() > kMaxAims) {
      std::ranges::stable_sort(objects_, std::greater(), [](const RayTarget& one) { return one.stratum.solid_angle(); });
      objects_.resize(kMaxAims);
    }
    images.resize(std::min(images.size(), kMaxAims - objects_.size()));
    leave_out(all - objects_.size() - images.size());
  }

  void leave_out(size_t count) {
    out_.num_left_out += static_cast<int64_t>(count);
    out_.any_unaimed = out_.any_unaimed || count > 0;
    out_.any_still_unaimed = out_.any_still_unaimed || count > 0;
  }

  // Returns the images of the things, those over the fewest mirrors first. Behind the most that are kept none is looked for:
  // a town that is one object has hundreds of thousands.
  std::vector<RayTarget> images_of(std::vector<Thing>& things) {
    std::vector<std::vector<RayTarget>> of_things(things.size());
    size_t num_found = 0;
    for (int num_mirrors = 1; num_mirrors <= finder_.most_mirrors(); ++num_mirrors) {
      for (size_t k = 0; k < things.size(); ++k) {
        heed_cancelling();
        const size_t before = of_things[k].size();
        if (num_found < kMostThings) finder_.add_images(things[k].target, num_mirrors, of_things[k]);
        else leave_out(finder_.least_images(things[k].target, num_mirrors));
        num_found += of_things[k].size() - before;
      }
    }
    std::vector<RayTarget> images;
    for (std::vector<RayTarget>& of_thing : of_things) append(std::move(of_thing), images);
    std::ranges::stable_sort(images, has_fewer_mirrors);
    return images;
  }

  // Together the things have the weight of one object, and their images no more than that.
  void aim_at(std::vector<Thing>& things) {
    const double share = 1.0 / static_cast<double>(things.size());
    for (Thing& thing : things) {
      thing.direct.weight *= share;
      objects_.push_back(std::move(thing.direct));
    }
    std::vector<RayTarget> images = images_of(things);
    const size_t num_kept = std::min(images.size(), kMostThings);
    leave_out(images.size() - num_kept);
    images.resize(num_kept);
    for (RayTarget& image : images) image.weight *= std::min(share, 1.0 / static_cast<double>(images.size()));
    images_.push_back(std::move(images));
  }

  const Scene& scene_;
  const EmbreeScene& geometry_;
  const RayTargetSettings& settings_;
  const RayTargetFinder finder_;
  const std::vector<bool> is_still_;     // [mesh ID]
  const std::vector<bool> holds_still_;  // [node]
  RayTargets& out_;
  std::vector<RayTarget> objects_;
  std::vector<std::vector<RayTarget>> images_;  // of one target after the other
  std::vector<Whole> wholes_;
};

}  // namespace

double weight_of_target(int num_mirrors) { return num_mirrors < 2 ? 1.0 : std::pow(0.25, num_mirrors - 1); }

RayTargets find_ray_targets(const Scene& scene, const EmbreeScene& geometry, const std::vector<Mirror>& mirrors,
                            const RayTargetSettings& settings) {
  RayTargets out;
  if (settings.fitted) settings.fitted->begin_plan();
  const int64_t num_objects = count_objects(scene);
  out.object_of_mesh.assign(scene.meshes().size(), -1);
  out.any_unaimed = num_objects > settings.most_objects;
  if (out.any_unaimed) out.num_left_out = num_objects;
  if (out.any_unaimed || num_objects == 0) return out;
  TargetSearch search(scene, geometry, mirrors, settings, out);
  for (const SceneObject& object : objects_of(scene)) search.take(object);
  search.finish();
  return out;
}

}  // namespace echopath
