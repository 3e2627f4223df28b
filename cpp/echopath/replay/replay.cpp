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
  set_mesh_levels();
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
      local.point = local.corner + local.u * local.edge_u + local.v * local.edge_v;
      local.normal = local.edge_u.cross(local.edge_v).normalized();
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

Replayer::NodeValues Replayer::evaluate_level(const Block& block, const Level& level) const {
  const size_t num_paths = block.paths.size(), channels = static_cast<size_t>(num_channels());
  const size_t num_nodes = level.instants.size(), node_stride = channels * num_paths;
  NodeValues values{std::vector<double>(num_nodes * node_stride), std::vector<std::complex<double>>(num_nodes * node_stride)};
  EvaluationScratch scratch;
  scratch.hits.resize(static_cast<size_t>(std::max(block.longest, 1)));
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
  return by_channel(once, indices.size(), evaluate_level(localise(indices), once));
}

std::vector<Echoes> Replayer::exact(std::span<const int64_t> indices) const {
  const Level& every_chirp = level(kExactLevel);
  return by_channel(every_chirp, indices.size(), evaluate_level(localise(indices), every_chirp));
}

std::vector<Echoes> Replayer::interpolated(std::span<const int64_t> indices, int index, std::vector<int64_t>& failed) const {
  const Level& polynomial = level(index);
  NodeValues values = evaluate_level(localise(indices), polynomial);
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
    for (size_t i = at; i < values.amplitudes.size(); i += node_stride) largest = std::max(largest, std::abs(values.amplitudes[i]));
    for (int piece = 0; piece < nodes.num_pieces(); ++piece) {
      const size_t first = static_cast<size_t>(piece * nodes.order) * node_stride + at;
      if (radio_.wavenumber * tail_of(nodes, &values.lengths[first], node_stride) > settings_.phase_tolerance) return false;
      if (tail_of(nodes, &values.amplitudes[first], node_stride) > settings_.amplitude_tolerance * largest) return false;
    }
  }
  return true;
}

// Levels that cost less than evaluation in every chirp.
int Replayer::count_levels() const {
  if (settings_.exact) return 0;
  int count = 0;
  while (count + 1 < kExactLevel && std::ssize(level(count + 1).nodes.times) <= num_exact_nodes()) ++count;
  return count;
}

// The distances of a mesh's outermost vertices from the transmitters tell how many nodes its motion needs: an echo's length
// is made of such distances.
bool Replayer::fits(const Level& level, uint32_t mesh_id) const {
  const size_t num_vertices = level.instants.front().local_vertices(mesh_id).size();
  const size_t step = std::max<size_t>(1, num_vertices / 16);
  for (size_t vertex = 0; vertex < num_vertices; vertex += step) {
    std::vector<double> distance;
    for (const Instant& instant : level.instants) {
      const Vec3 point = instant.rotation(mesh_id) * instant.local_vertices(mesh_id)[vertex] + instant.translation(mesh_id);
      distance.push_back(2.0 * (point - instant.transmitters.front().position).norm());
    }
    for (int piece = 0; piece < level.nodes.num_pieces(); ++piece) {
      const double* first = distance.data() + piece * level.nodes.order;
      if (radio_.wavenumber * tail_of(level.nodes, first, 1) > settings_.phase_tolerance) return false;
    }
  }
  return true;
}

void Replayer::set_mesh_levels() {
  num_levels_ = count_levels();
  for (uint32_t id = 0; id < mesh_moves_.size(); ++id) {
    int& needed = mesh_level_.emplace_back(1);
    if (mesh_moves_[id] == 0 && !radar_.motion) continue;
    while (needed <= num_levels_ && !fits(level(needed), id)) ++needed;
  }
}

int Replayer::first_level(int64_t path) const {
  const Hit* hits = paths_.hits_of(path);
  int needed = std::min(1, num_levels_ + 1);
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
  single.instants.emplace_back(*paths_.scene, radar_, paths_.frame.transmitter, time);
  const auto channels = static_cast<size_t>(num_channels());
  lengths.resize(channels * indices.size());
  amplitudes.resize(channels * indices.size());
  parallel_for(static_cast<int64_t>((indices.size() + kBlock - 1) / kBlock), [&](int64_t i) {
    const size_t begin = static_cast<size_t>(i) * kBlock, size = std::min(kBlock, indices.size() - begin);
    const NodeValues values = evaluate_level(localise(indices.subspan(begin, size)), single);
    for (size_t channel = 0; channel < channels; ++channel) {
      const auto from = static_cast<ptrdiff_t>(channel * size), to = static_cast<ptrdiff_t>(channel * indices.size() + begin);
      std::copy_n(values.lengths.begin() + from, size, lengths.begin() + to);
      std::copy_n(values.amplitudes.begin() + from, size, amplitudes.begin() + to);
    }
  }, job);
}

}  // namespace echopath
