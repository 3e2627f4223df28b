#include "echopath/trace/embree/embree_device.h"

#include "echopath/base/errors.h"
#include "echopath/base/lanes/simd.h"

namespace echopath {
namespace {

// Embree picks the best instruction set itself, unless another one is asked for (base/lanes/simd.h).
const char* device_options() {
#if defined(ECHOPATH_THREAD_SANITIZER)
  return "threads=1";  // what TBB's workers do in libraries that are not instrumented would look like races
#elif defined(ECHOPATH_X86_KERNELS)
  if (!is_instruction_set_asked() || instruction_set() == InstructionSet::kAvx512) return nullptr;
  return instruction_set() == InstructionSet::kAvx2 ? "isa=avx2" : "isa=sse2";
#else
  return nullptr;
#endif
}

}  // namespace

EmbreeScene::Device::Device() : device(rtcNewDevice(device_options())) {
  if (!device) throw DeviceError("Embree: no device could be made");
}

EmbreeScene::Device::~Device() {
  if (scene) rtcReleaseScene(scene);
  rtcReleaseDevice(device);
}

#if RTC_VERSION_MAJOR >= 4
void EmbreeScene::Device::intersect(RTCRayHit& query) const { rtcIntersect1(scene, &query); }

void EmbreeScene::Device::intersect(const ValidLanes& valid, RTCRayHit16& packet, PacketWay way) const {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  if (way == PacketWay::kTogether) arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
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

void EmbreeScene::Device::intersect(const ValidLanes& valid, RTCRayHit16& packet, PacketWay way) const {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  if (way == PacketWay::kTogether) context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
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
