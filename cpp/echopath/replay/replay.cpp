#include "echopath/replay/replay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/parallel.h"
#include "echopath/scene/smooth.h"

namespace echopath {
namespace {

constexpr std::array<int, 5> kOrders = {6, 10, 16, 24, 32};
constexpr int kStaticLevel = 0;
constexpr int kExactLevel = static_cast<int>(kOrders.size()) + 1;

}  // namespace

// Instants of one choice of nodes; made once, used by all blocks.
struct Replayer::Level {
  FrameNodes nodes;
  std::vector<Instant> instants;
};

struct Replayer::Block {
  std::vector<LocalHit> hits;
  std::deque<std::array<Vec3, 3>> normals;  // addresses stay
  std::vector<LocalPath> paths;
  int longest = 0;

  // Null where the crease guard refuses the facet.
  const std::array<Vec3, 3>* smooth_normals(const LocalHit& hit, const std::vector<Vec3>& of_vertices) {
    const std::array<Vec3, 3> corners = {of_vertices[hit.triangle[0]], of_vertices[hit.triangle[1]], of_vertices[hit.triangle[2]]};
    if (!is_smooth_facet(hit.edge_u.cross(hit.edge_v).normalized(), corners)) return nullptr;
    return &normals.emplace_back(corners);
  }
};

Replayer::Replayer(const Paths& paths, const Radar& radar, const ReplaySettings& settings)
    : paths_(paths), radar_(radar), settings_(settings), levels_(kExactLevel + 1) {
  radar.validate();
  require(settings.phase_tolerance > 0, "phase_tolerance", "must be positive", settings.phase_tolerance);
  paths.scene->require_times(paths.frame.start_time, paths.frame.start_time + radar.frame_duration());
  radio_.transmit_power = radar.transmit_power;
  radio_.wavelength = kSpeedOfLight / radar.waveform.start_frequency;
  radio_.wavenumber = kTwoPi / radio_.wavelength;
  radio_.footprint = paths.frame.footprint;
  radio_.spread = footprint_spread(paths.frame.sampler);
  for (uint32_t id = 0; id < paths.scene->meshes().size(); ++id) {
    mesh_moves_.push_back(paths.scene->is_moving(id));
    const Node& node = paths.scene->node_of(id);
    mesh_is_mirror_.push_back(node.material->mirror);
    smooth_normals_.push_back(node.smooth ? vertex_normals(node.mesh->vertices(), node.mesh->triangles()) : std::vector<Vec3>());
  }
  trace_instant_ = std::make_unique<Instant>(*paths.scene, paths.radar, paths.frame.transmitter, paths.frame.trace_time);
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

const Replayer::Level& Replayer::level(int index) const {
  const std::lock_guard lock(levels_mutex_);
  std::unique_ptr<const Level>& slot = levels_[static_cast<size_t>(index)];
  if (slot) return *slot;
  auto made = std::make_unique<Level>();
  const double start = paths_.frame.start_time;
  if (index == kStaticLevel) made->nodes = static_nodes(radar_, paths_.frame.trace_time);
  else if (index == kExactLevel) made->nodes = exact_nodes(radar_, start, exact_order());
  else {
    std::vector<double> breakpoints = paths_.scene->breakpoints();
    if (radar_.motion) {
      const std::vector<double> own = radar_.motion->breakpoints();
      breakpoints.insert(breakpoints.end(), own.begin(), own.end());
      std::sort(breakpoints.begin(), breakpoints.end());
    }
    made->nodes = chebyshev_nodes(radar_, start, breakpoints, kOrders[static_cast<size_t>(index - 1)]);
  }
  for (const double time : made->nodes.times) made->instants.emplace_back(*paths_.scene, radar_, paths_.frame.transmitter, time);
  slot = std::move(made);
  return *slot;
}

Replayer::Block Replayer::localise(std::span<const int64_t> indices) const {
  Block block;
  size_t num_hits = 0;
  for (const int64_t index : indices) num_hits += paths_.num_bounces[static_cast<size_t>(index)];
  block.hits.reserve(num_hits);  // paths point into it
  block.paths.reserve(indices.size());
  for (const int64_t index : indices) {
    const auto p = static_cast<size_t>(index);
    LocalPath& path = block.paths.emplace_back();
    path.hits = block.hits.data() + block.hits.size();
    path.count = paths_.num_bounces[p];
    path.is_reversed = (paths_.flags[p] & kReversedPath) != 0;
    if (!paths_.jones.empty()) path.jones = &paths_.jones[p];
    path.weight = std::complex<double>(paths_.weight[p]);
    block.longest = std::max(block.longest, path.count);
    for (int k = 0; k < path.count; ++k) {
      const int recorded = path.is_reversed ? path.count - 1 - k : k;
      const Hit& hit = paths_.hits_of(index)[recorded];
      path.diffuse |= (paths_.diffuse[p] >> recorded & 1) << k;
      const Node& node = paths_.scene->node_of(hit.mesh_id);
      LocalHit& local = block.hits.emplace_back();
      local.mesh_id = hit.mesh_id;
      local.deformed = node.sequence != nullptr;
      local.triangle = node.mesh->triangles()[hit.triangle_id];
      local.u = hit.u;
      local.v = hit.v;
      const std::vector<Vec3>& vertices = node.mesh->vertices();
      local.corner = vertices[local.triangle[0]];
      local.edge_u = vertices[local.triangle[1]] - local.corner;
      local.edge_v = vertices[local.triangle[2]] - local.corner;
      if (node.smooth) local.normals = block.smooth_normals(local, smooth_normals_[hit.mesh_id]);
      if (mesh_is_mirror_[hit.mesh_id] && !path.is_diffuse(k)) {
        path.image |= uint64_t{1} << k;
      } else {
        if (path.first_material < 0) path.first_material = k;
        path.last_material = k;
      }
    }
  }
  EvaluationScratch scratch;
  scratch.hits.resize(static_cast<size_t>(std::max(block.longest, 1)));
  for (size_t i = 0; i < indices.size(); ++i) add_cell(block.paths[i], indices[i], scratch);
  return block;
}

// The launch cell of the path's own stratum on the triangle of the physical-optics hit.
void Replayer::add_cell(LocalPath& path, int64_t index, EvaluationScratch& scratch) const {
  const auto p = static_cast<size_t>(index);
  const size_t stratum = paths_.stratum[p];
  if (path.diffuse != 0 || path.last_material < 0 || stratum >= paths_.frame.strata.size()) return;
  LaunchCell& cell = path.cell;
  cell.ray_density = paths_.frame.lattice_density(stratum);
  if (!paths_.curved_cell.empty() && paths_.curved_cell[p] != std::array<float, 7>{}) {
    const std::array<float, 7>& record = paths_.curved_cell[p];
    cell.is_curved = cell.is_known = true;
    for (int a = 0; a < 2; ++a) cell.tangent[a] = {record[2 * a], record[2 * a + 1]};
    std::copy(record.begin() + 4, record.end(), cell.turn);
    return;
  }
  if (paths_.frame.footprint != Footprint::kNone) set_flat_cell(path, scratch);
}

void Replayer::set_flat_cell(LocalPath& path, EvaluationScratch& scratch) const {
  PosedHit* hits = scratch.hits.data();
  pose_hits(path, *trace_instant_, hits);
  static const AntennaPattern isotropic;
  const PosedAntenna centre{Vec3::Zero(), Vec3::UnitX(), Vec3::UnitZ(), &isotropic};
  const AntennaLeg in = transmit_leg(path, hits, centre);
  double length = in.length;
  Vec3 arrival = in.travel;
  int previous = path.first_material;
  for (int k = previous + 1; k <= path.last_material; ++k) {
    if (path.is_image(k)) continue;
    const InnerLeg leg = inner_leg(hits, previous, k);
    length += leg.length;
    arrival = leg.arrival;
    previous = k;
  }
  const PosedHit& hit = hits[path.last_material];
  const double cos_in = std::abs(hit.normal.dot(arrival));
  const double side = length / std::sqrt(path.cell.ray_density);  // of the tube, m
  Vec3 along = arrival - hit.normal.dot(arrival) * hit.normal;
  along = along.norm() > 1e-9 ? along.normalized() : hit.normal.unitOrthogonal();
  const Vec3 across = hit.normal.cross(along);
  path.cell.tangent[0] = edge_coordinates(hit.edge_u, hit.edge_v, hit.normal, along * (side / std::max(cos_in, 1e-3)));
  path.cell.tangent[1] = edge_coordinates(hit.edge_u, hit.edge_v, hit.normal, across * side);
  path.cell.is_known = path.cell.tangent[0].allFinite() && path.cell.tangent[1].allFinite();
}

// Values [node, channel, path]; false when `check` finds a tail above the tolerance.
bool Replayer::evaluate_level(const Block& block, const Level& level, bool check, std::vector<double>& lengths,
                              std::vector<std::complex<double>>& amplitudes) const {
  const size_t num_paths = block.paths.size(), channels = static_cast<size_t>(num_channels());
  const size_t num_nodes = level.instants.size(), node_stride = channels * num_paths;
  lengths.resize(num_nodes * node_stride);
  amplitudes.resize(num_nodes * node_stride);
  EvaluationScratch scratch;
  scratch.hits.resize(static_cast<size_t>(std::max(block.longest, 1)));
  for (size_t node = 0; node < num_nodes; ++node) {
    for (size_t p = 0; p < num_paths; ++p) {
      const ChannelValues out{lengths.data() + node * node_stride + p, amplitudes.data() + node * node_stride + p,
                              static_cast<int64_t>(num_paths)};
      evaluate_path(block.paths[p], level.instants[node], radio_, scratch, out);
    }
  }
  if (!check) return true;
  const int order = level.nodes.order;
  for (int piece = 0; piece < level.nodes.num_pieces(); ++piece) {
    const double* values = lengths.data() + static_cast<size_t>(piece * order) * node_stride;
    for (size_t i = 0; i < node_stride; ++i) {
      double before_last = 0.0, last = 0.0;
      for (int k = 0; k < order; ++k) {
        // Relative to the first node: the sums must not drown in the rounding of the whole length.
        const double value = values[static_cast<size_t>(k) * node_stride + i] - values[i];
        before_last += level.nodes.tail[static_cast<size_t>(k)] * value;
        last += level.nodes.tail[static_cast<size_t>(order + k)] * value;
      }
      if (radio_.wavenumber * (std::abs(last) + 0.25 * std::abs(before_last)) > settings_.phase_tolerance) return false;
    }
  }
  return true;
}

std::vector<Echoes> Replayer::still(std::span<const int64_t> indices) const {
  std::vector<double> lengths;
  std::vector<std::complex<double>> amplitudes;
  evaluate_level(localise(indices), level(kStaticLevel), false, lengths, amplitudes);
  return by_channel(level(kStaticLevel), indices.size(), lengths, amplitudes);
}

std::vector<Echoes> Replayer::exact(std::span<const int64_t> indices) const {
  std::vector<double> lengths;
  std::vector<std::complex<double>> amplitudes;
  evaluate_level(localise(indices), level(kExactLevel), false, lengths, amplitudes);
  return by_channel(level(kExactLevel), indices.size(), lengths, amplitudes);
}

std::optional<std::vector<Echoes>> Replayer::interpolated(std::span<const int64_t> indices) const {
  if (settings_.exact) return std::nullopt;
  const Block block = localise(indices);
  std::vector<double> lengths;
  std::vector<std::complex<double>> amplitudes;
  for (int index = kStaticLevel + 1; index < kExactLevel; ++index) {
    if (std::ssize(level(index).nodes.times) > num_exact_nodes()) break;
    if (evaluate_level(block, level(index), true, lengths, amplitudes)) {
      return by_channel(level(index), indices.size(), lengths, amplitudes);
    }
  }
  return std::nullopt;
}

// From [node, channel, path] to the form that synthesis takes.
std::vector<Echoes> Replayer::by_channel(const Level& level, size_t num_paths, const std::vector<double>& lengths,
                                         const std::vector<std::complex<double>>& amplitudes) const {
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
        echoes.delay[to + p] = lengths[from + p] / kSpeedOfLight;
        echoes.amplitude[to + p] = amplitudes[from + p];
      }
    }
  }
  return out;
}

void Replayer::evaluate(std::span<const int64_t> indices, double time, std::vector<double>& lengths,
                        std::vector<std::complex<double>>& amplitudes, Job* job) const {
  constexpr size_t kBlock = 8192;
  Level single;
  single.instants.emplace_back(*paths_.scene, radar_, paths_.frame.transmitter, time);
  const auto channels = static_cast<size_t>(num_channels());
  lengths.resize(channels * indices.size());
  amplitudes.resize(channels * indices.size());
  parallel_for(static_cast<int64_t>((indices.size() + kBlock - 1) / kBlock), [&](int64_t i) {
    const size_t begin = static_cast<size_t>(i) * kBlock, size = std::min(kBlock, indices.size() - begin);
    std::vector<double> block_lengths;
    std::vector<std::complex<double>> block_amplitudes;
    evaluate_level(localise(indices.subspan(begin, size)), single, false, block_lengths, block_amplitudes);
    for (size_t channel = 0; channel < channels; ++channel) {
      const auto from = static_cast<ptrdiff_t>(channel * size), to = static_cast<ptrdiff_t>(channel * indices.size() + begin);
      std::copy_n(block_lengths.begin() + from, size, lengths.begin() + to);
      std::copy_n(block_amplitudes.begin() + from, size, amplitudes.begin() + to);
    }
  }, job);
}

}  // namespace echopath
