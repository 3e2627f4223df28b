#include "echopath/bench/moved_geometry.h"

#include "echopath/base/errors.h"
#include "echopath/bench/stopwatch.h"
#include "echopath/trace/embree/embree_device.h"

namespace echopath {
namespace {

// A scene of Embree's with a tree per mesh, and nothing else.
class BareScene {
 public:
  explicit BareScene(const Scene& scene) : scene_(scene), device_(rtcNewDevice(nullptr)), trees_(rtcNewScene(device_)) {
    rtcSetSceneFlags(trees_, RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC);
    rtcSetSceneBuildQuality(trees_, RTC_BUILD_QUALITY_LOW);
    for (uint32_t mesh_id = 0; mesh_id < scene.meshes().size(); ++mesh_id) add(mesh_id);
  }
  ~BareScene() {
    rtcReleaseScene(trees_);
    rtcReleaseDevice(device_);
  }
  BareScene(const BareScene&) = delete;
  BareScene& operator=(const BareScene&) = delete;

  void write(uint32_t mesh_id, const PosedScene& pose) {
    RTCGeometry geometry = rtcGetGeometry(trees_, mesh_id);
    auto* out = static_cast<float*>(rtcGetGeometryBufferData(geometry, RTC_BUFFER_TYPE_VERTEX, 0));
    for (const Vec3& vertex : pose.world_vertices(mesh_id)) {
      for (int axis = 0; axis < 3; ++axis) *out++ = static_cast<float>(vertex[axis]);
    }
  }
  void commit(const std::vector<uint32_t>& moved) {
    for (const uint32_t mesh_id : moved) {
      RTCGeometry geometry = rtcGetGeometry(trees_, mesh_id);
      rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
      rtcCommitGeometry(geometry);
    }
    rtcCommitScene(trees_);
  }

 private:
  void add(uint32_t mesh_id) {
    const Mesh& mesh = *scene_.node_of(mesh_id).mesh;
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float),
                            mesh.vertices().size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.triangles().data(), 0,
                               sizeof(Triangle), mesh.triangles().size());
    rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
    rtcAttachGeometryByID(trees_, geometry, mesh_id);
    rtcReleaseGeometry(geometry);
  }

  const Scene& scene_;
  RTCDevice device_;
  RTCScene trees_;
};

template <class Work>
double processor_seconds(const Work& work) {
  const Stopwatch watch;
  work();
  return watch.processor();
}

std::vector<uint32_t> meshes_that(const Scene& scene, bool move) {
  std::vector<uint32_t> found;
  for (uint32_t mesh_id = 0; mesh_id < scene.meshes().size(); ++mesh_id) {
    if (scene.is_moving(mesh_id) == move) found.push_back(mesh_id);
  }
  return found;
}

}  // namespace

MovedGeometry measure_moved_geometry(const Scene& scene, const std::vector<double>& times) {
  require(!times.empty(), "times", "must not be empty", "none");
  MovedGeometry out;
  const std::vector<uint32_t> moving = meshes_that(scene, true), resting = meshes_that(scene, false);
  EmbreeScene own;
  BareScene bare(scene);
  for (size_t i = 0; i < times.size(); ++i) {
    const PosedScene pose(scene, times[i]);
    const double seconds =
        processor_seconds([&] { own.update(scene, pose, Vec3::Zero(), EmbreeScene::Upkeep::kTimes, nullptr); });
    std::vector<uint32_t> changed = moving;
    if (i == 0) changed.insert(changed.end(), resting.begin(), resting.end());
    for (const uint32_t mesh_id : changed) bare.write(mesh_id, pose);
    const double of_embree = processor_seconds([&] { bare.commit(changed); });
    if (i == 0) {
      out.first = seconds;
      continue;
    }
    out.again.push_back(seconds);
    out.bare.push_back(of_embree);
  }
  return out;
}

}  // namespace echopath
