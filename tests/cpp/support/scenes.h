#pragma once
// Small scenes and quantities that several C++ tests need.
#include <cmath>
#include <complex>
#include <memory>
#include <string>
#include <vector>

#include "echopath/base/constants.h"
#include "echopath/replay/replay.h"
#include "echopath/trace/trace.h"

namespace echopath::testing {

inline MaterialPtr share(const Material& material) { return std::make_shared<const Material>(material); }

inline MaterialPtr lambert(double reflectivity) {
  Material material;
  material.reflectivity = reflectivity;
  material.scattering = 1.0;
  return share(material);
}

inline void add_mesh(Scene& scene, const std::string& name, std::vector<Vec3> vertices, std::vector<Triangle> triangles,
                     MaterialPtr material, std::shared_ptr<const Motion> motion = nullptr) {
  Node node;
  node.name = name;
  node.mesh = std::make_shared<Mesh>(std::move(vertices), std::move(triangles));
  node.material = std::move(material);
  node.motion = std::move(motion);
  scene.add(node);
}

// Rectangle with the given corner and edges.
inline void add_rectangle(Scene& scene, const std::string& name, const Vec3& corner, const Vec3& a, const Vec3& b,
                          MaterialPtr material, std::shared_ptr<const Motion> motion = nullptr) {
  add_mesh(scene, name, {corner, corner + a, corner + a + b, corner + b}, {{0, 1, 2}, {0, 2, 3}}, std::move(material),
           std::move(motion));
}

// Ellipsoid of 20 * 4^subdivisions triangles.
struct Surface {
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
};
Surface ellipsoid(const Vec3& centre, const Vec3& semi_axes, int subdivisions);

inline Node node_with(const std::string& name, Surface surface, MaterialPtr material, bool smooth = false) {
  Node node;
  node.name = name;
  node.mesh = std::make_shared<Mesh>(std::move(surface.vertices), std::move(surface.triangles));
  node.material = std::move(material);
  node.smooth = smooth;
  return node;
}

// Adds a metal ball of 20 * 4^subdivisions triangles, whose normals are interpolated.
void add_smooth_ball(Scene& scene, const std::string& name, const Vec3& centre, double radius, int subdivisions);

inline Antenna antenna_at(const Vec3& position, double gain = 1.0) {
  Antenna antenna;
  antenna.position = position;
  antenna.pattern = AntennaPattern::isotropic(gain);
  return antenna;
}

// 77 GHz, one chirp, one isotropic antenna each.
inline Radar plain_radar(const Vec3& transmitter, const Vec3& receiver, double gain = 1.0, double power = 1.0) {
  Radar radar;
  radar.waveform.num_chirps = 1;
  radar.transmit_power = power;
  radar.transmitters = {antenna_at(transmitter, gain)};
  radar.receivers = {antenna_at(receiver, gain)};
  return radar;
}

inline TraceSettings with_rays(int64_t num_rays, int max_bounces = TraceSettings{}.max_bounces) {
  TraceSettings settings;
  settings.num_rays = num_rays;
  settings.max_bounces = max_bounces;
  return settings;
}

struct Replayed {
  std::vector<double> lengths;
  std::vector<std::complex<double>> amplitudes;
};

// At the trace time, first antennas.
Replayed replayed(const Paths& paths);

// Sum of a e^{-jkL} over all paths.
std::complex<double> coherent_sum(const Paths& paths);

// sigma = |sum a|^2 (4 pi)^3 R^4 / (Q^2 lambda^2) in m^2, for Q^2 = Pt Gt Gr = 1.
double rcs_of(double power, double range, double frequency);

inline double decibel(double power) { return 10.0 * std::log10(power); }

}  // namespace echopath::testing
