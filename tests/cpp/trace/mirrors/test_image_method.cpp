// A path over two mirrors that meet at a right angle, against where it is by symmetry.
#include <gtest/gtest.h>

#include "cpp/support/scenes.h"
#include "echopath/trace/mirrors/image_method.h"

namespace echopath::test_image_method {
namespace {

constexpr double kAside = 2e-5;  // m: the receiver is moved by half of it

// The way back to the same antenna meets both walls in their edge: half of its field belongs to each order of the walls, and
// the points of either half are beside the edge.
TEST(ImageMethod, APathThroughAnEdgeHasHalfOfTheFieldAndItsPointsAreThere) {
  Scene scene;
  const MaterialPtr metal = testing::share(Material::metal(true));
  testing::add_rectangle(scene, "right", Vec3(0, 0, -1), Vec3(4, 0, 0), Vec3(0, 0, 3), metal);
  testing::add_rectangle(scene, "left", Vec3(0, 0, -1), Vec3(0, 0, 3), Vec3(0, 4, 0), metal);
  const EmbreeScene geometry(scene, PosedScene(scene, 0.0), Vec3::Zero());
  const std::vector<Mirror> mirrors = find_mirrors(scene, geometry);
  SbrSettings settings;
  settings.transmitter = settings.receiver = Vec3(2.0, 1.0, 0.5);
  const MeshLocator locator;
  ImageMethod images(geometry, mirrors, locator, settings);
  for (const std::vector<int>& sequence : {std::vector<int>{0, 1}, std::vector<int>{1, 0}}) {
    const std::optional<ImagePath> path = images.path_over(sequence);
    ASSERT_TRUE(path);
    EXPECT_NEAR(std::abs(path->weight), 1.0, 1e-12);
    EXPECT_EQ(path->share, 0.5);
    ASSERT_EQ(path->points.size(), 2u);
    for (const Vec3& point : path->points) EXPECT_LT((point - Vec3(0.0, 0.0, 0.5)).norm(), kAside);
  }
}

}  // namespace
}  // namespace echopath::test_image_method
