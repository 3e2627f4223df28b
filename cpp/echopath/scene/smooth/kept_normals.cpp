#include "echopath/scene/smooth/kept_normals.h"

#include <algorithm>
#include <map>
#include <mutex>

#include "echopath/scene/smooth/smooth.h"

namespace echopath {
namespace {

using Normals = std::shared_ptr<const std::vector<Vec3>>;

constexpr size_t kLeastBytes = size_t{16} << 20;  // of new normals, between two looks for meshes that are no more

class NormalsByMesh {
 public:
  Normals find(const MeshPtr& mesh) {
    const std::lock_guard lock(mutex_);
    const auto found = by_mesh_.find(mesh);
    return found == by_mesh_.end() ? nullptr : found->second;
  }

  void keep(const MeshPtr& mesh, const Normals& normals) {
    const std::lock_guard lock(mutex_);
    new_bytes_ += normals->size() * sizeof(Vec3);
    if (new_bytes_ > std::max(kLeastBytes, kept_bytes_)) forget_dead();
    by_mesh_.insert_or_assign(mesh, normals);
  }

 private:
  void forget_dead() {
    std::erase_if(by_mesh_, [](const auto& entry) { return entry.first.expired(); });
    kept_bytes_ = new_bytes_ = 0;
    for (const auto& [mesh, normals] : by_mesh_) kept_bytes_ += normals->size() * sizeof(Vec3);
  }

  std::mutex mutex_;
  std::map<std::weak_ptr<const Mesh>, Normals, std::owner_less<>> by_mesh_;
  size_t kept_bytes_ = 0, new_bytes_ = 0;
};

}  // namespace

Normals kept_vertex_normals(const MeshPtr& mesh) {
  static NormalsByMesh& of_process = *new NormalsByMesh;  // never destroyed: threads may outlive what is static
  Normals normals = of_process.find(mesh);
  if (normals) return normals;
  normals = std::make_shared<const std::vector<Vec3>>(vertex_normals(*mesh));
  of_process.keep(mesh, normals);
  return normals;
}

}  // namespace echopath
