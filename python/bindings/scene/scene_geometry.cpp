#include "scene/scene_geometry.h"

#include <map>
#include <mutex>

namespace echopath::bindings {
namespace {

using Snapshot = std::weak_ptr<const Scene>;

struct Remembered {
  std::mutex mutex;
  std::map<Snapshot, std::weak_ptr<KeptGeometry>, std::owner_less<Snapshot>> by_snapshot;
};

Remembered& remembered() {
  static Remembered& of_process = *new Remembered;  // never destroyed: threads may outlive what is static
  return of_process;
}

}  // namespace

void remember_geometry(const std::shared_ptr<const Scene>& snapshot, const std::shared_ptr<KeptGeometry>& kept) {
  Remembered& all = remembered();
  const std::lock_guard lock(all.mutex);
  std::erase_if(all.by_snapshot, [](const auto& entry) { return entry.first.expired() || entry.second.expired(); });
  all.by_snapshot.insert_or_assign(snapshot, kept);
}

std::shared_ptr<KeptGeometry> geometry_of(const std::shared_ptr<const Scene>& snapshot) {
  Remembered& all = remembered();
  const std::lock_guard lock(all.mutex);
  const auto found = all.by_snapshot.find(snapshot);
  return found == all.by_snapshot.end() ? nullptr : found->second.lock();
}

}  // namespace echopath::bindings
