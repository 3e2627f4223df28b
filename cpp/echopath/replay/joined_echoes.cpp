#include "echopath/replay/joined_echoes.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "echopath/base/lanes/simd.h"

namespace echopath {

JoinRule::JoinRule(const Paths& paths, const PathPreparer& preparer, SpecularPoints specular,
                   std::vector<const std::vector<uint32_t>*> labels)
    : paths_(paths), preparer_(preparer), slides_(specular != SpecularPoints::kMaterial), labels_(std::move(labels)) {}

std::vector<uint8_t> JoinRule::operator()(std::span<const int64_t> paths) const {
  std::vector<uint8_t> joined(paths.size());
  if (slides_) return joined;
  for (size_t i = 1; i < paths.size(); ++i) {
    joined[i] = is_joined(static_cast<size_t>(paths[i - 1]), static_cast<size_t>(paths[i]));
  }
  return joined;
}

bool JoinRule::is_joined(size_t before, size_t path) const {
  if (paths_.offsets[before] != paths_.offsets[path] || paths_.num_bounces[before] != paths_.num_bounces[path]) return false;
  if (preparer_.has_lobe(static_cast<int64_t>(path)) || preparer_.has_lobe(static_cast<int64_t>(before))) return false;
  if (!paths_.passes_of(before).empty() || !paths_.passes_of(path).empty()) return false;
  if (paths_.flags[before] != paths_.flags[path] || paths_.batch[before] != paths_.batch[path]) return false;
  const auto is_alike = [&](const std::vector<uint32_t>* label) { return (*label)[before] == (*label)[path]; };
  return std::ranges::all_of(labels_, is_alike) && has_same_images(before, path);
}

bool JoinRule::has_same_images(size_t before, size_t path) const {
  const Hit* hits = paths_.hits_of(static_cast<int64_t>(path));
  uint64_t differ = paths_.diffuse[before] ^ paths_.diffuse[path];
  for (; differ != 0; differ &= differ - 1) {
    if (preparer_.is_mirror(hits[std::countr_zero(differ)].mesh_id)) return false;
  }
  return true;
}

std::vector<uint32_t> echoes_of(std::span<const uint8_t> joined) {
  std::vector<uint32_t> echoes;
  echoes.reserve(joined.size());
  for (const uint8_t is_joined : joined) echoes.push_back(echoes.empty() ? 0 : echoes.back() + !is_joined);
  return echoes;
}

namespace {

// Describes `count` neighbouring echoes, each of which is the sum of `members` echoes.
struct Run {
  size_t from, to, count, members;
};

std::vector<Run> runs_of(std::span<const uint8_t> joined) {
  std::vector<Run> runs;
  size_t to = 0;
  for (size_t i = 0, members = 0; i < joined.size(); i += members, ++to) {
    for (members = 1; i + members < joined.size() && joined[i + members];) ++members;
    if (runs.empty() || runs.back().members != members) runs.push_back({i, to, 0, members});
    ++runs.back().count;
  }
  return runs;
}

ECHOPATH_INLINE void join_pairs(const double* delay, const double* amplitude, size_t count, double* __restrict to_delay,
                                double* __restrict to_amplitude) {
  for (size_t i = 0; i < count; ++i) {
    to_delay[i] = delay[2 * i];
    to_amplitude[2 * i] = amplitude[4 * i] + amplitude[4 * i + 2];
    to_amplitude[2 * i + 1] = amplitude[4 * i + 1] + amplitude[4 * i + 3];
  }
}

void join_many(const double* delay, const double* amplitude, const Run& run, double* to_delay, double* to_amplitude) {
  std::fill_n(to_amplitude, 2 * run.count, 0.0);
  for (size_t i = 0; i < run.count * run.members; ++i) {
    if (i % run.members == 0) to_delay[i / run.members] = delay[i];
    for (size_t part = 0; part < 2; ++part) to_amplitude[2 * (i / run.members) + part] += amplitude[2 * i + part];
  }
}

void join_run(const double* delay, const double* amplitude, const Run& run, double* to_delay, double* to_amplitude) {
  if (run.members > 2) return join_many(delay, amplitude, run, to_delay, to_amplitude);
  if (run.members == 2) return run_simd<join_pairs>(delay, amplitude, run.count, to_delay, to_amplitude);
  std::copy_n(delay, run.count, to_delay);
  std::copy_n(amplitude, 2 * run.count, to_amplitude);
}

}  // namespace

void join(const Echoes& all, std::span<const uint8_t> joined, Echoes& to) {
  const std::vector<Run> runs = runs_of(joined);
  const auto from = static_cast<size_t>(all.num_echoes), stride = static_cast<size_t>(to.num_echoes);
  const auto* amplitude = reinterpret_cast<const double*>(all.amplitude.data());
  auto* to_amplitude = reinterpret_cast<double*>(to.amplitude.data());
  for (size_t row = 0; row < static_cast<size_t>(all.sampling.num_rows); ++row) {
    for (const Run& run : runs) {
      const size_t source = row * from + run.from, place = row * stride + run.to;
      join_run(all.delay.data() + source, amplitude + 2 * source, run, to.delay.data() + place, to_amplitude + 2 * place);
    }
  }
}

std::vector<int64_t> first_of(std::span<const int64_t> paths, std::span<const uint8_t> joined) {
  std::vector<int64_t> first;
  first.reserve(paths.size());
  for (size_t i = 0; i < paths.size(); ++i) {
    if (!joined[i]) first.push_back(paths[i]);
  }
  return first;
}

}  // namespace echopath
