#include "echopath/record/blocks/path_fan.h"

#include <algorithm>

namespace echopath {
namespace {

uint32_t shortest_bent(const FanLeg* legs, uint32_t count) {
  uint32_t found = count;
  for (uint32_t k = 0; k < count; ++k) {
    if (legs[k].num_hits > 0 && (found == count || legs[k].num_hits < legs[found].num_hits)) found = k;
  }
  return found;
}

}  // namespace

void PathRows::skip_rows(size_t count) {
  offsets += count;
  num_bounces += count;
  diffuse += count;
  weight += count;
  stratum += count;
  batch += count;
  flags += count;
}

void PathRows::skip_hits(size_t count) {
  hits += count;
  first_hit += static_cast<int64_t>(count);
}

FanPairs::FanPairs(const PathFan& fan, const FanLeg* legs, const Hit* hits)
    : fan_(fan), in_(legs), out_(legs + fan.num_in), hits_(hits), bent_in_(shortest_bent(in_, fan.num_in)),
      bent_out_(shortest_bent(out_, fan.num_out)) {}

FanPairs::Pair FanPairs::host(Pair pair) const {
  const Pair bent_out{pair.in, bent_out_};
  if (out_[pair.out].num_hits == 0 && bent_out_ < fan_.num_out && fits(bent_out)) pair = bent_out;
  const Pair bent_in{bent_in_, pair.out};
  if (in_[pair.in].num_hits == 0 && bent_in_ < fan_.num_in && fits(bent_in)) pair = bent_in;
  return pair;
}

template <class Visit>
void FanPairs::for_each(const Visit& visit) const {
  for (uint32_t in = 0; in < fan_.num_in; ++in) {
    for (uint32_t out = 0; out < fan_.num_out; ++out) {
      if (fits({in, out})) visit(Pair{in, out});
    }
  }
}

void FanPairs::count(size_t& num_paths, size_t& num_hits) const {
  for_each([&](Pair pair) {
    ++num_paths;
    if (host(pair) == pair) num_hits += length(pair);
  });
}

void FanPairs::write(PathRows& rows, std::vector<int64_t>& places) const {
  places.resize(size_t{fan_.num_in} * fan_.num_out);
  const auto place = [&](Pair pair) -> int64_t& { return places[size_t{pair.in} * fan_.num_out + pair.out]; };
  for_each([&](Pair pair) {
    if (!(host(pair) == pair)) return;
    place(pair) = rows.first_hit;
    write_hits(pair, rows.hits);
    rows.skip_hits(length(pair));
  });
  for_each([&](Pair pair) {
    const Pair on = host(pair);
    write_row(pair, place(on) + in_[on.in].num_hits - in_[pair.in].num_hits, rows);
  });
}

void FanPairs::write_hits(Pair pair, Hit* to) const {
  const FanLeg &in = in_[pair.in], &out = out_[pair.out];
  to = std::copy_n(hits_ + in.first_hit, in.num_hits, to);
  *to++ = fan_.hit;
  std::copy_n(hits_ + out.first_hit, out.num_hits, to);
}

void FanPairs::write_row(Pair pair, int64_t offset, PathRows& rows) const {
  const std::complex<float> a = in_[pair.in].factor, b = out_[pair.out].factor;
  *rows.offsets = offset;
  *rows.num_bounces = static_cast<uint8_t>(length(pair));
  *rows.diffuse = uint64_t{1} << in_[pair.in].num_hits;
  *rows.weight = {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
  *rows.stratum = fan_.stratum;
  *rows.batch = fan_.batch;
  *rows.flags = fan_.flags;
  rows.skip_rows(1);
}

}  // namespace echopath
