#pragma once
// Records what a geometry asks Embree, and asks it again.
#include <memory>

#include "echopath/bench/query_log.h"
#include "echopath/trace/embree/embree_scene.h"

namespace echopath {

// While it lives, every query of `geometry`, by whatever thread, is written into `log` before Embree gets it. Both must
// outlive it; no query may be under way when it begins and ends.
class QueryRecorder {
 public:
  QueryRecorder(EmbreeScene& geometry, QueryLog& log);
  ~QueryRecorder();
  QueryRecorder(const QueryRecorder&) = delete;
  QueryRecorder& operator=(const QueryRecorder&) = delete;

 private:
  class RecordedQueries;
  EmbreeScene& geometry_;
  const EmbreeScene::Queries& before_;
  std::unique_ptr<RecordedQueries> recorded_;
};

// Asks the queries between two marks of a log again, packed as they were or (`one_by_one`) each for itself, and does nothing
// else.
void ask_again(const EmbreeScene& geometry, const QueryLog& log, QueryLog::Mark begin, QueryLog::Mark end, bool one_by_one);

}  // namespace echopath
