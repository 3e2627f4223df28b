#include "echopath/label/objects/families.h"

#include <algorithm>
#include <iterator>
#include <map>

#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"

namespace echopath {
namespace {

constexpr int64_t kPathsSortedTogether = 1 << 16;

// Identifies a family by indices into SurfaceMap::names; it sorts as the families do.
struct Key {
  uint32_t owner = 0;  // num_objects for the background
  uint32_t order = 0, ghost_type = 0;
  std::vector<uint32_t> via;
  auto operator<=>(const Key&) const = default;
};

void classify_hits(const Hit* hits, int num_hits, const SurfaceMap& surfaces, Key& key) {
  key = {surfaces.num_objects, 0, 0, {}};
  for (int k = 0; k < num_hits; ++k) key.owner = std::min(key.owner, surfaces.of_mesh[hits[k].mesh_id]);
  if (key.owner == surfaces.num_objects) return;

  uint32_t last = static_cast<uint32_t>(surfaces.names.size());
  for (int k = 0; k < num_hits; ++k) {
    const uint32_t at = surfaces.of_mesh[hits[k].mesh_id];
    const bool is_within = at == last && surfaces.is_object(at);
    if (!is_within) ++key.order;
    const bool is_new = at != key.owner && std::ranges::find(key.via, at) == key.via.end();
    if (is_new) key.via.push_back(at);
    last = at;
  }
  if (key.order > 1) key.ghost_type = last == key.owner ? 1 : 2;
}

// Holds the families of a range of paths, numbered as they come.
struct Block {
  std::map<Key, uint32_t> index_of;
  std::vector<uint32_t> local;  // [paths of the range]
};

Block classify_block(const Paths& paths, const SurfaceMap& surfaces, int64_t begin, int64_t end) {
  Block block;
  block.local.reserve(end - begin);
  Key key;
  auto found = block.index_of.end();
  for (int64_t path = begin; path < end; ++path) {
    classify_hits(paths.hits_of(path), paths.num_bounces[path], surfaces, key);
    const bool is_like_the_last = found != block.index_of.end() && found->first == key;  // neighbours often are
    if (!is_like_the_last) found = block.index_of.try_emplace(key, static_cast<uint32_t>(block.index_of.size())).first;
    block.local.push_back(found->second);
  }
  return block;
}

Family family_of(const Key& key, const SurfaceMap& surfaces) {
  Family family;
  if (key.owner == surfaces.num_objects) return family;
  family.object = surfaces.names[key.owner];
  family.ghost_type = static_cast<int>(key.ghost_type);
  family.order = static_cast<int>(key.order);
  for (const uint32_t surface : key.via) family.via.push_back(surfaces.names[surface]);
  return family;
}

// Returns the index of each key that occurs, in the order of the keys.
std::map<Key, uint32_t> number_keys(const std::vector<Block>& blocks, const SurfaceMap& surfaces) {
  std::map<Key, uint32_t> index_of{{Key{surfaces.num_objects, 0, 0, {}}, 0}};  // the background, which sorts last
  for (const Block& block : blocks) index_of.insert(block.index_of.begin(), block.index_of.end());
  uint32_t next = 0;
  for (auto& [key, index] : index_of) index = next++;
  return index_of;
}

}  // namespace

int Family::class_code() const {
  constexpr int kMainObject = 100, kTypeOne = 10, kTypeTwo = 20;
  if (object.empty()) return 0;
  if (ghost_type == 0) return kMainObject + kTypeOne + 1;
  if (order == 2) return kMainObject + (ghost_type == 1 ? kTypeOne : kTypeTwo) + 2;
  if (order == 3 && ghost_type == 2) return kMainObject + kTypeTwo + 4;
  return kMainObject;
}

std::string Family::name() const {
  if (object.empty()) return "background";
  if (ghost_type == 0) return object;
  std::string text = object + ": type " + std::to_string(ghost_type) + ", order " + std::to_string(order);
  for (size_t i = 0; i < via.size(); ++i) text += (i == 0 ? " via " : ", ") + via[i];
  return text;
}

std::string Family::key() const {
  if (object.empty()) return {};
  std::string text = object;
  const auto add = [&text](const std::string& field) { (text += kBetweenFields) += field; };
  add(std::to_string(ghost_type));
  add(std::to_string(order));
  for (const std::string& surface : via) add(surface);
  return text;
}

Partition Families::partition() const {
  Partition partition;
  for (const Family& family : families) partition.names.push_back(family.key());
  partition.group = family_of_path;
  return partition;
}

Families find_families(const Paths& paths, const SurfaceMap& surfaces, Job* job) {
  require(paths.scene != nullptr && surfaces.of_mesh.size() == paths.scene->meshes().size(), "surfaces",
          "must be of the scene of the paths, meshes", surfaces.of_mesh.size());
  std::vector<Block> blocks(num_chunks(paths.num_paths(), kPathsSortedTogether));
  parallel_for_chunks(paths.num_paths(), kPathsSortedTogether, [&](int64_t begin, int64_t end) {
    blocks[begin / kPathsSortedTogether] = classify_block(paths, surfaces, begin, end);
  }, job);

  const std::map<Key, uint32_t> index_of = number_keys(blocks, surfaces);
  Families made;
  for (const auto& [key, index] : index_of) made.families.push_back(family_of(key, surfaces));
  made.family_of_path.reserve(paths.num_paths());
  for (const Block& block : blocks) {
    if (job) job->throw_if_cancelled();
    std::vector<uint32_t> global(block.index_of.size());
    for (const auto& [key, local] : block.index_of) global[local] = index_of.at(key);
    std::ranges::transform(block.local, std::back_inserter(made.family_of_path),
                           [&](uint32_t local) { return global[local]; });
  }
  return made;
}

}  // namespace echopath
