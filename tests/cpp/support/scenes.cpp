#include "cpp/support/scenes.h"

#include <map>
#include <numeric>

namespace echopath::testing {
namespace {

Surface icosahedron() {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  // clang-format off
  return {{{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0}, {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g}, {g, 0, -1},
           {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}},
          {{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4}, {11, 10, 2}, {10, 7, 6},
           {7, 1, 8}, {3, 9, 4}, {3, 4, 2}, {3, 2, 6}, {3, 6, 8}, {3, 8, 9}, {4, 9, 5}, {2, 4, 11}, {6, 2, 10}, {8, 6, 7},
           {9, 8, 1}}};
  // clang-format on
}

Surface subdivided(const Surface& coarse) {
  Surface fine{coarse.vertices, {}};
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles;
  const auto middle = [&](uint32_t a, uint32_t b) {
    const auto [entry, is_new] = middles.try_emplace(std::minmax(a, b), static_cast<uint32_t>(fine.vertices.size()));
    if (is_new) fine.vertices.push_back((coarse.vertices[a].normalized() + coarse.vertices[b].normalized()) / 2.0);
    return entry->second;
  };
  for (const auto& [a, b, c] : coarse.triangles) {
    const uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const Triangle& part : {Triangle{a, ab, ca}, Triangle{b, bc, ab}, Triangle{c, ca, bc}, Triangle{ab, bc, ca}}) {
      fine.triangles.push_back(part);
    }
  }
  return fine;
}

}  // namespace

Surface ellipsoid(const Vec3& centre, const Vec3& semi_axes, int subdivisions) {
  Surface surface = icosahedron();
  for (int i = 0; i < subdivisions; ++i) surface = subdivided(surface);
  for (Vec3& vertex : surface.vertices) vertex = centre + semi_axes.cwiseProduct(vertex.normalized());
  return surface;
}

void add_smooth_ball(Scene& scene, const std::string& name, const Vec3& centre, double radius, int subdivisions) {
  Surface surface = ellipsoid(centre, {radius, radius, radius}, subdivisions);
  Node ball = node_with(name, std::move(surface), share(Material::metal()), true);
  scene.add(ball);
}

Replayed replayed(const Paths& paths) {
  std::vector<int64_t> all(static_cast<size_t>(paths.num_paths()));
  std::iota(all.begin(), all.end(), int64_t{0});
  Replayed out;
  Replayer(paths, paths.radar).evaluate(all, paths.frame.trace_time, out.lengths, out.amplitudes);
  return out;
}

std::complex<double> coherent_sum(const Paths& paths) {
  const Replayed replay = replayed(paths);
  const double wavenumber = kTwoPi * paths.radar.waveform.start_frequency / kSpeedOfLight;
  std::complex<double> sum = 0.0;
  for (size_t i = 0; i < replay.lengths.size(); ++i) {
    sum += replay.amplitudes[i] * std::polar(1.0, -std::fmod(wavenumber * replay.lengths[i], kTwoPi));
  }
  return sum;
}

double rcs_of(double power, double range, double frequency) {
  const double wavelength = kSpeedOfLight / frequency;
  return power * std::pow(4.0 * kPi, 3) * std::pow(range, 4) / (wavelength * wavelength);
}

}  // namespace echopath::testing
