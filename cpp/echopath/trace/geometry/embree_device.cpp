#include "echopath/trace/geometry/embree_device.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "echopath/base/errors.h"
#include "echopath/base/simd.h"

namespace echopath {
namespace {

// Embree picks the best instruction set itself, unless another one is asked for (base/simd.h).
const char* device_options() {
#if defined(ECHOPATH_THREAD_SANITIZER)
  return "threads=1";  // what TBB's workers do in libraries that are not instrumented would look like races
#elif defined(ECHOPATH_X86_KERNELS)
  const char* asked = std::getenv("ECHOPATH_INSTRUCTION_SET");
  if (!asked || !*asked || instruction_set() == InstructionSet::kAvx512) return nullptr;
  return instruction_set() == InstructionSet::kAvx2 ? "isa=avx2" : "isa=sse2";
#else
  return nullptr;
#endif
}

bool keep_building(void* job, double) { return job == nullptr || !static_cast<Job*>(job)->cancelled(); }

}  // namespace

EmbreeScene::Device::Device() : device(rtcNewDevice(device_options())) {
  if (!device) throw DeviceError("Embree: no device could be made");
}

EmbreeScene::Device::~Device() {
  if (scene) rtcReleaseScene(scene);
  rtcReleaseDevice(device);
}

void EmbreeScene::Device::check(const char* what) const {
  const RTCError code = rtcGetDeviceError(device);
  if (code == RTC_ERROR_CANCELLED) throw Cancelled();
  if (code != RTC_ERROR_NONE) throw DeviceError(std::string("Embree: ") + what + " failed, code " + std::to_string(code));
}

void EmbreeScene::Device::start_scene(size_t num_meshes, bool tree_per_mesh) {
  if (scene) rtcReleaseScene(scene);
  scene = rtcNewScene(device);
  has_tree_per_mesh = tree_per_mesh;
  has_mesh.assign(num_meshes, false);
  rtcSetSceneFlags(scene, tree_per_mesh ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC : RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene, tree_per_mesh ? RTC_BUILD_QUALITY_LOW : RTC_BUILD_QUALITY_MEDIUM);
}

void EmbreeScene::Device::set_mesh(unsigned mesh_id, const std::vector<Vec3>& vertices,
                                   const std::vector<Triangle>& triangles, unsigned mask) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* points = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), vertices.size()));
  auto* indices = static_cast<uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), triangles.size()));
  if (!points || !indices) {
    rtcReleaseGeometry(geometry);
    throw DeviceError("Embree: out of memory for " + std::to_string(triangles.size()) + " triangles");
  }
  for (size_t i = 0; i < vertices.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) points[3 * i + axis] = static_cast<float>(vertices[i][axis]);
  }
  for (size_t i = 0; i < triangles.size(); ++i) std::copy(triangles[i].begin(), triangles[i].end(), indices + 3 * i);
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_MEDIUM);
  rtcSetGeometryMask(geometry, mask);
  rtcCommitGeometry(geometry);
  if (has_mesh[mesh_id]) rtcDetachGeometry(scene, mesh_id);
  rtcAttachGeometryByID(scene, geometry, mesh_id);
  has_mesh[mesh_id] = true;
  rtcReleaseGeometry(geometry);
}

void EmbreeScene::Device::build(Job* job) {
  rtcSetSceneProgressMonitorFunction(scene, keep_building, job);
  rtcCommitScene(scene);
  rtcSetSceneProgressMonitorFunction(scene, nullptr, nullptr);
  if (job) job->throw_if_cancelled();
  check("building the scene");
}

#if RTC_VERSION_MAJOR >= 4
void EmbreeScene::Device::intersect(RTCRayHit& query) const { rtcIntersect1(scene, &query); }

void EmbreeScene::Device::intersect(const ValidLanes& valid, RTCRayHit16& packet) const {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
  rtcIntersect16(valid.lanes, scene, &packet, &arguments);
}

void EmbreeScene::Device::occluded(RTCRay& ray) const { rtcOccluded1(scene, &ray); }

void EmbreeScene::Device::occluded(const ValidLanes& valid, RTCRay16& rays) const {
  rtcOccluded16(valid.lanes, scene, &rays);
}
#else
void EmbreeScene::Device::intersect(RTCRayHit& query) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &query);
}

void EmbreeScene::Device::intersect(const ValidLanes& valid, RTCRayHit16& packet) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid.lanes, scene, &context, &packet);
}

void EmbreeScene::Device::occluded(RTCRay& ray) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded1(scene, &context, &ray);
}

void EmbreeScene::Device::occluded(const ValidLanes& valid, RTCRay16& rays) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcOccluded16(valid.lanes, scene, &context, &rays);
}
#endif

}  // namespace echopath
