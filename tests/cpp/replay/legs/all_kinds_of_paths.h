#pragma once
// A scene that has all kinds of paths, and the radar of several antennas that sees it.
#include "cpp/support/scenes.h"

namespace echopath::testing {

inline MaterialPtr rough(double diffuse_share, bool mirror) {
  Material material;
  material.permittivity = std::complex<double>(5.0, -0.3);
  material.scattering = std::sqrt(diffuse_share);
  material.mirror = mirror;
  return share(material);
}

inline void add_body(Scene& scene, const std::string& name, const Vec3& centre, const Transform& placement,
                     std::shared_ptr<const Motion> motion, bool smooth = false) {
  Surface surface = ellipsoid(Vec3::Zero(), {.4, .3, .5}, 3);
  Node node = testing::node_with(name, std::move(surface), rough(0.5, false), smooth);
  node.placement = Eigen::Translation3d(centre) * placement;
  node.motion = std::move(motion);
  scene.add(node);
}

// Mirrors that scatter too, of which one drives away; bodies that turn, one of them smooth, one stretched along its way, one
// that stands, all but flat.
inline Scene scene_of_all_kinds(bool has_mirrors = true) {
  Scene scene;
  add_rectangle(scene, "left", {-20, 3, -1}, {60, 0, 0}, {0, 0, 12}, rough(0.2, has_mirrors));
  add_rectangle(scene, "ground", {-20, -20, -1}, {60, 0, 0}, {0, 40, 0}, rough(0.1, has_mirrors));
  add_rectangle(scene, "van", {14, -3, -1}, {0, 6, 0}, {0, 0, 3}, rough(0.2, has_mirrors),
                std::make_shared<LinearMotion>(Vec3(12, 0, 0)));
  const auto turns = std::make_shared<LinearMotion>(Vec3(-3, 1, 0), Vec3(0.5, 1, 4));
  add_body(scene, "near", {6, 0.5, 0}, Transform::Identity(), turns);
  add_body(scene, "smooth", {8, 1.5, 0.5}, Transform(Eigen::Scaling(0.7)), turns, true);
  add_body(scene, "far", {9, -1, 0.3}, Transform(Eigen::Scaling(1.0, 2.0, 0.5)), turns);
  add_body(scene, "plate", {7, -2, 0.2},
           Transform(Eigen::AngleAxisd(0.7, Vec3(0.1, 0.2, 1).normalized()) * Eigen::Scaling(1.0, 3.0, 1e-6)), nullptr);
  return scene;
}

inline Radar array() {
  Radar radar = plain_radar(Vec3::Zero(), Vec3::Zero());
  radar.transmitters.push_back(antenna_at({0, 0.02, 0.01}));
  for (const double y : {-0.02, 0.05}) radar.receivers.push_back(antenna_at({0, y, 0.02}));
  for (Antenna& antenna : radar.receivers) antenna.pattern = AntennaPattern::cosine_power(3.0);
  radar.transmitters[1].pattern = AntennaPattern::cosine_power(2.5);
  radar.transmitters[1].orientation = Quaternion(Eigen::AngleAxisd(0.3, Vec3::UnitZ()));
  radar.motion = std::make_shared<LinearMotion>(Vec3(5, 0, 0), Vec3(0, 0, 0.4));
  return radar;
}

inline Paths record(const Radar& radar, bool has_mirrors = true,
                    PolarizationModel polarization = PolarizationModel::kScalar) {
  TraceSettings settings = testing::with_rays(1200, 4);
  settings.polarization = polarization;
  return trace(scene_of_all_kinds(has_mirrors), radar, settings);
}

// Gains that kernels raise to powers themselves.
inline Radar array_of_powers() {
  Radar radar = array();
  radar.transmitters[1].pattern = AntennaPattern::cosine_power(2.0);
  return radar;
}

}  // namespace echopath::testing
