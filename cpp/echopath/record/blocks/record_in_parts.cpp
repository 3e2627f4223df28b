#include "echopath/record/blocks/record_in_parts.h"

#include <utility>

namespace echopath {
namespace {

template <class Column>
void append_column(const Column& more, Column& column) {
  column.insert(column.end(), more.begin(), more.end());
}

// An optional column exists from the first part that has it, with zeros before.
template <class Column>
void append_optional(const Column& more, size_t num_before, size_t num_more, Column& column) {
  if (more.empty() && column.empty()) return;
  column.resize(num_before);
  append_column(more, column);
  column.resize(num_before + num_more);
}

void append_passes(const Paths& part, size_t num_before, Paths& whole) {
  if (part.pass_offsets.empty() && whole.pass_offsets.empty()) return;
  if (whole.pass_offsets.empty()) whole.pass_offsets.assign(num_before + 1, 0);
  const int64_t first = std::ssize(whole.passes);
  append_column(part.passes, whole.passes);
  for (int64_t path = 1; path <= part.num_paths(); ++path)
    whole.pass_offsets.push_back(part.pass_offsets.empty() ? first : first + part.pass_offsets[path]);
}

}  // namespace

RecordInParts::RecordInParts(const Paths& empty, std::optional<int64_t> paths_per_part, std::function<Paths(Paths)> finished)
    : empty_(empty), paths_per_part_(paths_per_part), finished_(std::move(finished)), whole_(empty) {
  begin_part();
}

void RecordInParts::begin_part() {
  part_ = empty_;
  part_.frame.statistics = {};
  writer_.emplace(part_);
}

void RecordInParts::expect(const std::vector<PathBlock>& like, int64_t num_blocks) {
  if (!paths_per_part_) writer_->expect(like, num_blocks);
}

void RecordInParts::append(const std::vector<const PathBlock*>& blocks, Job* job) {
  writer_->append(blocks, job);
  if (!paths_per_part_ || part_.num_paths() < *paths_per_part_) return;
  add(end_part());
  begin_part();
}

Paths RecordInParts::end_part() {
  writer_->finish();
  return finished_(std::move(part_));
}

void RecordInParts::add(const Paths& part) {
  if (!hits_) hits_ = std::make_shared<std::vector<Hit>>();
  const size_t num_before = whole_.offsets.size(), num_more = part.offsets.size();
  const int64_t first_hit = std::ssize(*hits_);
  append_column(*part.hits, *hits_);
  for_each_column([&](auto column) { append_column(part.*column, whole_.*column); });
  for (size_t path = num_before; path < whole_.offsets.size(); ++path) whole_.offsets[path] += first_hit;
  append_optional(part.curved_cell, num_before, num_more, whole_.curved_cell);
  append_optional(part.jones, num_before, num_more, whole_.jones);
  append_passes(part, num_before, whole_);
  whole_.frame.statistics.add(part.frame.statistics);
}

Paths RecordInParts::take() {
  Paths last = end_part();
  if (!hits_) {  // the only part is the record
    last.frame.statistics.add(empty_.frame.statistics);
    return last;
  }
  add(last);
  whole_.hits = std::move(hits_);
  return std::move(whole_);
}

}  // namespace echopath
