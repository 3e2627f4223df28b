#include "echopath/replay/replay.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/parallel.h"

namespace echopath {
namespace {

constexpr std::array<int, 10> kOrders = {4, 6, 8, 10, 12, 14, 16, 20, 24, 32};
constexpr int kStaticLevel = 0;
constexpr int kExactLevel = static_cast<int>(kOrders.size()) + 1;

// What a polynomial through `order` values, `stride` apart, has left: from its last two Chebyshev coefficients.
template <typename Value>
double tail_of(const FrameNodes& nodes, const Value* values, size_t stride) {
  const auto order = static_cast<size_t>(nodes.order);
  Value before_last = 0.0, last = 0.0;
  for (size_t k = 0; k < order; ++k) {
    // Relative to the first node: the sums must not drown in the rounding of the whole length.
    const Value value = values[k * stride] - values[0];
    before_last += nodes.tail[k] * value;
    last += nodes.tail[order + k] * value;
  }
  return std::abs(last) + 0.25 * std::abs(before_last);
}

}  // namespace

// Instants of one choice of nodes; made once, used by all blocks.
struct Replayer::Level {
  FrameNodes nodes;
  std::vector<Instant> instants;
};

// [node, channel, path]
struct Replayer::NodeValues {
  std::vector<double> lengths;                    // m
  std::vector<std::complex<double>> amplitudes;   // sqrt(W)
};

Replayer::Replayer(const Paths& paths, const Radar& radar, const ReplaySettings& settings)
    : paths_(paths), radar_(radar), settings_(settings), localise_(paths, hit_patches(paths)), levels_(kExactLevel + 1) {
  radar.validate();
  require(settings.phase_tolerance > 0, "phase_tolerance", "must be positive", settings.phase_tolerance);
  paths.scene->require_times(paths.frame.start_time, paths.frame.start_time + radar.frame_duration());
  radio_ = radio_constants(paths, radar);
  radio_.specular = settings.specular;
  for (uint32_t id = 0; id < paths.scene->meshes().size(); ++id) mesh_moves_.push_back(paths.scene->is_moving(id));
}

Replayer::~Replayer() = default;

int Replayer::num_channels() const { return static_cast<int>(radar_.transmitters.size() * radar_.receivers.size()); }

bool Replayer::is_static(int64_t path) const {
  if (radar_.motion) return false;
  const Hit* hits = paths_.hits_of(path);
  const int count = paths_.num_bounces[static_cast<size_t>(path)];
  return std::none_of(hits, hits + count, [&](const Hit& hit) { return mesh_moves_[hit.mesh_id] != 0; });
}

// Nodes in a chirp: value and slope in its middle, or its delay throughout.
int Replayer::exact_order() const { return settings_.per_sample ? 5 : 3; }

int64_t Replayer::num_exact_nodes() const {
  return int64_t{radar_.num_slots()} * radar_.waveform.num_chirps * exact_order();
}

Instant Replayer::instant(double time) const {
  return Instant(*paths_.scene, radar_, localise_.patches(), paths_.frame.transmitter, time);
}

const Replayer::Level& Replayer::level(int index) const {
  const std::lock_guard lock(levels_mutex_);
  std::unique_ptr<const Level>& slot = levels_[static_cast<size_t>(index)];
  if (slot) return *slot;
  auto made = std::make_unique<Level>();
  const double start = paths_.frame.start_time;
  if (index == kStaticLevel) made->nodes = static_nodes(radar_, paths_.frame.trace_time);
  else if (index == kExactLevel) made->nodes = exact_nodes(radar_, start, exact_order());
  else {
    made->nodes = chebyshev_nodes(radar_, start, breakpoints(), kOrders[static_cast<size_t>(index - 1)]);
  }
  for (const double time : made->nodes.times) made->instants.push_back(instant(time));
  slot = std::move(made);
  return *slot;
}

Replayer::NodeValues Replayer::evaluate_level(const LocalPaths& block, const Level& level) const {
  const size_t num_paths = block.paths.size(), channels = static_cast<size_t>(num_channels());
  const size_t num_nodes = level.instants.size(), node_stride = channels * num_paths;
  NodeValues values{std::vector<double>(num_nodes * node_stride), std::vector<std::complex<double>>(num_nodes * node_stride)};
  EvaluationScratch scratch(block.longest);
  for (size_t node = 0; node < num_nodes; ++node) {
    for (size_t p = 0; p < num_paths; ++p) {
      const ChannelValues out{values.lengths.data() + node * node_stride + p, values.amplitudes.data() + node * node_stride + p,
                              static_cast<int64_t>(num_paths)};
      evaluate_path(block.paths[p], level.instants[node], radio_, scratch, out);
    }
  }
  return values;
}

std::vector<Echoes> Replayer::still(std::span<const int64_t> indices) const {
  const Level& once = level(kStaticLevel);
  return by_channel(once, indices.size(), evaluate_level(localise_(indices), once));
}

std::vector<Echoes> Replayer::exact(std::span<const int64_t> indices) const {
  const Level& every_chirp = level(kExactLevel);
  return by_channel(every_chirp, indices.size(), evaluate_level(localise_(indices), every_chirp));
}

std::vector<Echoes> Replayer::interpolated(std::span<const int64_t> indices, int index, std::vector<int64_t>& failed) const {
  const Level& polynomial = level(index);
  NodeValues values = evaluate_level(localise_(indices), polynomial);
  const size_t num_paths = indices.size();
  for (size_t p = 0; p < num_paths; ++p) {
    if (follows(polynomial.nodes, values, num_paths, p)) continue;
    failed.push_back(indices[p]);
    for (size_t i = p; i < values.amplitudes.size(); i += num_paths) values.amplitudes[i] = 0.0;
  }
  return by_channel(polynomial, num_paths, values);
}

// The polynomials follow lengths and amplitudes of path `p` in all channels.
bool Replayer::follows(const FrameNodes& nodes, const NodeValues& values, size_t num_paths, size_t p) const {
  const size_t node_stride = static_cast<size_t>(num_channels()) * num_paths;
  for (size_t at = p; at < node_stride; at += num_paths) {
    double largest = 0.0;
    for (size_t i = at; i < values.amplitudes.size(); i += node_stride) largest = std::max(largest, std::norm(values.amplitudes[i]));
    for (int piece = 0; piece < nodes.num_pieces(); ++piece) {
      const size_t first = static_cast<size_t>(piece * nodes.order) * node_stride + at;
      if (radio_.wavenumber * tail_of(nodes, &values.lengths[first], node_stride) > settings_.phase_tolerance) return false;
      if (tail_of(nodes, &values.amplitudes[first], node_stride) > settings_.amplitude_tolerance * std::sqrt(largest)) return false;
    }
  }
  return true;
}

std::vector<double> Replayer::breakpoints() const {
  std::vector<double> times = paths_.scene->breakpoints();
  if (!radar_.motion) return times;
  const std::vector<double> own = radar_.motion->breakpoints();
  times.insert(times.end(), own.begin(), own.end());
  std::sort(times.begin(), times.end());
  return times;
}

// Levels that cost no more than evaluation in every chirp; nothing is posed for the others.
int Replayer::num_levels() const {
  if (settings_.exact) return 0;
  const double begin = paths_.frame.start_time, end = begin + radar_.frame_duration();
  const std::vector<double> cuts = breakpoints();
  const int64_t pieces = 1 + std::count_if(cuts.begin(), cuts.end(), [&](double t) { return t > begin && t < end; });
  return static_cast<int>(std::count_if(kOrders.begin(), kOrders.end(), [&](int order) { return pieces * order <= num_exact_nodes(); }));
}

// The distances of vertices all over a mesh from the transmitters tell how many nodes its motion needs: an echo's length is
// made of such distances.
bool Replayer::fits(const Level& level, uint32_t mesh_id) const {
  const Node& node = paths_.scene->node_of(mesh_id);
  const auto vertices_at = [&](const Instant& instant) -> const std::vector<Vec3>& {
    return node.deformation ? instant.deformed_vertices(mesh_id) : node.mesh->vertices();
  };
  const size_t num_vertices = vertices_at(level.instants.front()).size();
  const size_t step = std::max<size_t>(1, num_vertices / 16);
  for (size_t vertex = 0; vertex < num_vertices; vertex += step) {
    std::vector<double> distance;
    for (const Instant& instant : level.instants) {
      const Vec3 point = instant.rotation(mesh_id) * vertices_at(instant)[vertex] + instant.translation(mesh_id);
      distance.push_back(2.0 * (point - instant.transmitters.front().position).norm());
    }
    for (int piece = 0; piece < level.nodes.num_pieces(); ++piece) {
      const double* first = distance.data() + piece * level.nodes.order;
      if (radio_.wavenumber * tail_of(level.nodes, first, 1) > settings_.phase_tolerance) return false;
    }
  }
  return true;
}

void Replayer::find_mesh_levels() const {
  const int most = num_levels();
  for (uint32_t id = 0; id < mesh_moves_.size(); ++id) {
    int& needed = mesh_level_.emplace_back(1);
    if (mesh_moves_[id] == 0 && !radar_.motion) continue;
    while (needed <= most && !fits(level(needed), id)) ++needed;
  }
}

int Replayer::first_level(int64_t path) const {
  std::call_once(mesh_levels_made_, [&] { find_mesh_levels(); });
  const Hit* hits = paths_.hits_of(path);
  int needed = 1;
  for (int k = 0; k < paths_.num_bounces[static_cast<size_t>(path)]; ++k) needed = std::max(needed, mesh_level_[hits[k].mesh_id]);
  return needed;
}

// From [node, channel, path] to the form that synthesis takes.
std::vector<Echoes> Replayer::by_channel(const Level& level, size_t num_paths, const NodeValues& values) const {
  const size_t num_nodes = level.nodes.times.size();
  const auto channels = static_cast<size_t>(num_channels());
  std::vector<Echoes> out(channels);
  for (size_t channel = 0; channel < channels; ++channel) {
    Echoes& echoes = out[channel];
    echoes.sampling = level.nodes.sampling[channel / radar_.receivers.size()];
    echoes.num_echoes = static_cast<int64_t>(num_paths);
    echoes.delay.resize(num_nodes * num_paths);
    echoes.amplitude.resize(num_nodes * num_paths);
    for (size_t node = 0; node < num_nodes; ++node) {
      const size_t from = (node * channels + channel) * num_paths, to = node * num_paths;
      for (size_t p = 0; p < num_paths; ++p) {
        echoes.delay[to + p] = values.lengths[from + p] / kSpeedOfLight;
        echoes.amplitude[to + p] = values.amplitudes[from + p];
      }
    }
  }
  return out;
}

void Replayer::evaluate(std::span<const int64_t> indices, double time, std::vector<double>& lengths,
                        std::vector<std::complex<double>>& amplitudes, Job* job) const {
  constexpr size_t kBlock = 8192;
  Level single;
  single.instants.push_back(instant(time));
  const auto channels = static_cast<size_t>(num_channels());
  lengths.resize(channels * indices.size());
  amplitudes.resize(channels * indices.size());
  parallel_for(static_cast<int64_t>((indices.size() + kBlock - 1) / kBlock), [&](int64_t i) {
    const size_t begin = static_cast<size_t>(i) * kBlock, size = std::min(kBlock, indices.size() - begin);
    const NodeValues values = evaluate_level(localise_(indices.subspan(begin, size)), single);
    for (size_t channel = 0; channel < channels; ++channel) {
      const auto from = static_cast<ptrdiff_t>(channel * size), to = static_cast<ptrdiff_t>(channel * indices.size() + begin);
      std::copy_n(values.lengths.begin() + from, size, lengths.begin() + to);
      std::copy_n(values.amplitudes.begin() + from, size, amplitudes.begin() + to);
    }
  }, job);
}

}  // namespace echopath
