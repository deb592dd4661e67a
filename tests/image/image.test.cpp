#include "image/image.h"

#include "catch.h"
#include "error.h"

using namespace voxref;

TEST_CASE("an image keeps its channels by name and in order", "[image]") {
  Image image(3, 2);
  image.add_layer("direct");
  image.add("Z")[5] = 4.0f;
  CHECK(image.channels() == std::vector<std::string>{"direct.R", "direct.G", "direct.B", "Z"});
  CHECK(image.channel("Z")[5] == 4.0f);
  CHECK(image.add("Z")[5] == 4.0f);  // adding again changes nothing
  image.layer("direct")[1][0] = 2.0f;
  CHECK(image.channel("direct.G")[0] == 2.0f);
  CHECK(image.has_layer("direct"));
  CHECK_FALSE(image.has_layer(""));
  CHECK_THROWS_AS(image.channel("R"), Error);
}

TEST_CASE("sizes without pixels and absurd ones are refused", "[image]") {
  CHECK_THROWS_AS(Image(0, 5), Error);
  CHECK_THROWS_AS(Image(5, -1), Error);
  CHECK_THROWS_AS(Image(70000, 1), Error);
}
