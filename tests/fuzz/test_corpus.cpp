#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "fuzz/targets.h"

namespace echopath::fuzz {
namespace {

// Files that made a reader fail once, and seeds of each kind of content. A fault ends the program with a message.
TEST(Corpus, EveryFileIsReadOrRefused) {
  for (const Target& target : kTargets) {
    int count = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(ECHOPATH_FUZZ_CORPUS) / target.name)) {
      std::ifstream file(entry.path(), std::ios::binary);
      const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
      SCOPED_TRACE(entry.path());
      target.feed(bytes);
      ++count;
    }
    EXPECT_GE(count, 5) << target.name;
  }
}

TEST(DemandDeathTest, EndsTheProcessWhereAReaderBreaksItsPromise) { EXPECT_DEATH(demand(false, "it holds"), "it holds"); }

}  // namespace
}  // namespace echopath::fuzz
