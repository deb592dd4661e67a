// The judge of images: what `diff` says of each planted error, and that it says nothing of the kind where none is.
#include "compare/image_diff.h"

#include <atomic>
#include <cmath>
#include <functional>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>
#include <set>

#include "catch.h"
#include "compare/select_layer.h"
#include "compare/synthetic.h"
#include "error.h"

namespace voxref {

namespace {

constexpr int width = 96, height = 64;

Image reference() {
  Image image(width, height);
  testing::fill_layer(image, "", testing::wavy);
  return image;
}

/// The reference with normal noise of `relative` size, told in its standard errors.
Image noisy(unsigned seed, float relative = 0.02f) {
  Image image = reference();
  image.add_layer("stderr");
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  for (size_t c = 0; c < 3; ++c)
    for (size_t i = 0; i < image.pixel_count(); ++i) {
      float& value = image.layer("")[c][i];
      image.layer("stderr")[c][i] = relative * value;
      value += relative * value * normal(random);
    }
  return image;
}

void for_colors(Image& image, const std::function<glm::vec3(const glm::vec3&)>& change) {
  const auto planes = image.layer("");
  for (size_t i = 0; i < image.pixel_count(); ++i) {
    const glm::vec3 color = change({planes[0][i], planes[1][i], planes[2][i]});
    for (int c = 0; c < 3; ++c) planes[size_t(c)][i] = color[c];
  }
}

/// The image whose pixel (x, y) is the given one of the old image.
Image moved(const Image& image, const std::function<glm::ivec2(int x, int y)>& source) {
  Image result = image;
  for (const std::string& name : image.channels())
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const glm::ivec2 from = glm::clamp(source(x, y), glm::ivec2(0), glm::ivec2(width - 1, height - 1));
        result.channel(name)[size_t(y) * width + size_t(x)] =
            image.channel(name)[size_t(from.y) * width + size_t(from.x)];
      }
  return result;
}

struct Planted {
  const char* error;
  std::function<Image(Image)> plant;
  const char* cause;  ///< what `diff` must name; empty: it must name nothing
};

Image recolored(Image image, const std::function<glm::vec3(const glm::vec3&)>& change) {
  for_colors(image, change);
  return image;
}
Image scaled(Image image, float factor) {
  return recolored(std::move(image), [factor](const glm::vec3& c) { return factor * c; });
}
glm::vec3 encoded(const glm::vec3& c) { return {srgb_encode(c.r), srgb_encode(c.g), srgb_encode(c.b)}; }
glm::vec3 in_bytes(const glm::vec3& c) { return glm::round(255.0f * encoded(c)) / 255.0f; }

const std::vector<Planted>& planted_errors() {
  static const std::vector<Planted> errors = {
      {"y flipped", [](Image i) { return moved(i, [](int x, int y) { return glm::ivec2(x, height - 1 - y); }); },
       "y flipped"},
      {"x flipped", [](Image i) { return moved(i, [](int x, int y) { return glm::ivec2(width - 1 - x, y); }); },
       "x flipped"},
      {"turned by 180 degrees",
       [](Image i) { return moved(i, [](int x, int y) { return glm::ivec2(width - 1 - x, height - 1 - y); }); },
       "x flipped, y flipped"},
      {"one pixel to the right", [](Image i) { return moved(i, [](int x, int y) { return glm::ivec2(x - 1, y); }); },
       "shifted by (1, 0, 0) pixel"},
      {"half a pixel down",
       [](Image i) {
         const Image below = moved(i, [](int x, int y) { return glm::ivec2(x, y + 1); });
         for (size_t c = 0; c < 3; ++c)
           for (size_t k = 0; k < i.pixel_count(); ++k)
             i.layer("")[c][k] = 0.5f * (i.layer("")[c][k] + below.layer("")[c][k]);
         return i;
       },
       "shifted by half a pixel towards (0, -1, 0)"},
      {"BGR",
       [](Image i) { return recolored(std::move(i), [](const glm::vec3& c) { return glm::vec3(c.b, c.g, c.r); }); },
       "BGR stored as RGB"},
      {"encoded twice", [](Image i) { return recolored(std::move(i), encoded); }, "encoded as sRGB once too often"},
      {"encoded, in bytes", [](Image i) { return recolored(std::move(i), in_bytes); },
       "encoded as sRGB once too often"},
      {"missing 1/pi", [](Image i) { return scaled(std::move(i), std::numbers::pi_v<float>); }, "missing 1/pi"},
      {"1/pi twice", [](Image i) { return scaled(std::move(i), 1.0f / std::numbers::pi_v<float>); },
       "1/pi applied twice"},
      {"a factor", [](Image i) { return scaled(std::move(i), 1.7f); }, "a constant factor: 1.7 times"},
      {"+0.5 % everywhere", [](Image i) { return scaled(std::move(i), 1.005f); }, "a constant factor: 1.005 times"},
      {"flipped and encoded",
       [](Image i) { return recolored(moved(i, [](int x, int y) { return glm::ivec2(x, height - 1 - y); }), encoded); },
       "y flipped, and encoded as sRGB once too often"},
      {"a hot pixel",
       [](Image i) {
         i.channel("R")[width * 30 + 50] = 1000.0f;
         return i;
       },
       ""},
      {"a hot pixel at the edge",
       [](Image i) {
         i.channel("R")[0] = 1000.0f;
         return i;
       },
       ""},
      {"one material's albedo off by 2 %",
       [](Image i) { return recolored(std::move(i), [](const glm::vec3& c) { return c.r > 0.75f ? 1.02f * c : c; }); },
       ""},
  };
  return errors;
}

}  // namespace

TEST_CASE("Each planted error is found, and named where it is a classic one", "[diff]") {
  for (const Planted& planted : planted_errors()) {
    INFO(planted.error);
    const ImageDiff diff = diff_images(planted.plant(reference()), reference(), {.perceptual = false});
    CHECK(diff.verdict == Verdict::different);
    CHECK(!diff.reasons.empty());
    const std::string named = diff.causes.empty() ? "" : diff.causes.front().mistake;
    INFO("said: " << named);
    if (*planted.cause == '\0')
      CHECK(named.empty());
    else
      CHECK(named.starts_with(planted.cause));
  }
}

TEST_CASE("Under noise large planted errors are found and named too", "[diff]") {
  // Those that noise of 2 % hides, or lets other mistakes explain as well, are not asked for.
  unsigned seed = 1;
  for (const Planted& planted : planted_errors()) {
    const std::string error = planted.error;
    if (error.starts_with("half") || error.starts_with("one pixel") || error.starts_with("+0.5")) continue;
    INFO(error);
    const Image reference_image = noisy(seed++);
    const ImageDiff diff = diff_images(planted.plant(noisy(seed++)), reference_image, {.perceptual = false});
    CHECK(diff.verdict == Verdict::different);
    const std::string named = diff.causes.empty() ? "" : diff.causes.front().mistake;
    INFO("said: " << named);
    const std::string expected = error.starts_with("a factor") ? "a constant factor: 1." : planted.cause;
    if (expected.empty())
      CHECK(named.empty());
    else
      CHECK(named.starts_with(expected));
  }
}

TEST_CASE("Clean pairs get neither a wrong verdict nor a diagnosis, over 100 seeds", "[diff]") {
  // The significance of 1 % lets one of 100 be called different by chance; three are beyond 98 % of all such runs.
  int different = 0, diagnosed = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    const ImageDiff diff = diff_images(noisy(1000 + 2 * seed), noisy(1001 + 2 * seed), {.perceptual = false});
    different += diff.verdict == Verdict::different;
    diagnosed += !diff.causes.empty();
  }
  CHECK(different <= 3);
  CHECK(diagnosed == 0);
}

TEST_CASE("NaN fails whatever the limits allow, and is located", "[diff]") {
  const float nan_value = std::numeric_limits<float>::quiet_NaN();
  Image one = reference();
  one.channel("B")[width * 3 + 7] = nan_value;
  ImageDiffOptions generous{.perceptual = false};
  generous.limits.tolerance = {1e9, 1.0};
  generous.limits.fraction = 1.0;
  const ImageDiff diff = diff_images(one, reference(), generous);
  CHECK(diff.verdict == Verdict::different);
  REQUIRE(diff.all.first_nonfinite);
  CHECK(diff.all.first_nonfinite->at == glm::ivec3(7, 3, 0));
  CHECK(diff.all.first_nonfinite->channel == 2);
  CHECK(diff.causes.empty());
  Image all = reference();
  for (const auto& plane : all.layer("")) std::ranges::fill(plane, nan_value);
  CHECK(diff_images(all, all, generous).verdict == Verdict::different);
  CHECK(diff_images(all, all, {}).all.nonfinite_a == 3 * width * height);
}

TEST_CASE("A standard error that is NaN fails and is located: its pixel is not exact", "[diff]") {
  Image broken = noisy(1);
  broken.channel("stderr.G")[width * 5 + 9] = std::numeric_limits<float>::quiet_NaN();
  const ImageDiff diff = diff_images(broken, noisy(2), {.perceptual = false});
  CHECK(diff.verdict == Verdict::different);
  REQUIRE(diff.reasons.size() == 1);
  CHECK(diff.reasons[0] == "1 standard errors are NaN or infinite, the first at A pixel (9, 5) stderr.G: nan");
  CHECK(diff.causes.empty());
  CHECK(to_json(diff)["nonfinite_a"] == 1);
  CHECK(diff_images(noisy(2), broken, {.perceptual = false}).errors.b == 1);
}

TEST_CASE("A verdict that the image's mean alone keeps open quotes the image's mean", "[diff]") {
  ImageDiffOptions options{.perceptual = false};
  options.limits.noise.margin = 1e-6;  // no mean of these samples is known so well; tiles may be 5 % off
  const ImageDiff diff = diff_images(noisy(1), noisy(2), options);
  CHECK(diff.verdict == Verdict::too_noisy);
  REQUIRE(diff.noise);
  CHECK(diff.noise->tiles_open == 0);
  CHECK(diff.noise->image_open == 3);
  REQUIRE(diff.reasons.size() == 1);
  CHECK(diff.reasons[0].starts_with("3 of 3 image means and 0 of 18 tiles are too noisy to say: of the image's mean"));
}

TEST_CASE("A comparison tells how far it is, and stops where that is asked for", "[diff]") {
  const std::atomic<bool> stop = true;
  const Progress stopped{.report = {}, .cancel = &stop};
  CHECK_THROWS_AS(diff_images(reference(), reference(), {}, stopped), Interrupted);
  std::set<std::string> stages;
  const Progress watched{.report = [&](std::string_view stage, double) { stages.insert(std::string(stage)); },
                         .cancel = nullptr};
  diff_images(scaled(reference(), 3.0f), reference(), {}, watched);
  for (const char* stage : {"SSIM and FLIP", "HDR-FLIP", "Yee", "looking for the cause"}) CHECK(stages.contains(stage));
}

TEST_CASE("HDR-FLIP and Yee see what differs, and more of it where more does", "[diff]") {
  // A square four times as bright, of 8 and of 16 pixels; Yee's count is at most what was changed and the blur around.
  const auto with_square = [](int side) {
    Image image = reference();
    for (const auto& plane : image.layer(""))
      for (int y = 20; y < 20 + side; ++y)
        for (int x = 50; x < 50 + side; ++x) plane[size_t(y) * width + size_t(x)] *= 4.0f;
    return image;
  };
  const auto seen = [&](int side) { return *diff_images(with_square(side), reference(), {}).perceptual; };
  const PerceptualDifference small = seen(8), large = seen(16);
  CHECK(small.hdr_flip > 0.0);
  CHECK(large.hdr_flip > 2.0 * small.hdr_flip);
  CHECK(small.yee_pixels > 32);
  CHECK(large.yee_pixels > 2 * small.yee_pixels);
  CHECK(large.yee_pixels < width * height / 2);
}

TEST_CASE("Limits on metrics decide in place of the values", "[diff]") {
  const Image brighter = scaled(reference(), 1.02f);
  ImageDiffOptions options;
  options.limits.flip = 0.5;
  CHECK(diff_images(brighter, reference(), options).verdict == Verdict::same);
  options.limits.psnr = 60.0;
  const ImageDiff diff = diff_images(brighter, reference(), options);
  CHECK(diff.verdict == Verdict::different);
  REQUIRE(diff.reasons.size() == 1);
  CHECK(diff.reasons[0].starts_with("PSNR"));
  options.limits = {};
  options.limits.fraction = 1.0;
  CHECK(diff_images(brighter, reference(), options).verdict == Verdict::same);
}

TEST_CASE("Equal images have no difference by any metric", "[diff]") {
  const ImageDiff diff = diff_images(reference(), reference(), {});
  CHECK(diff.verdict == Verdict::same);
  CHECK(std::isinf(diff.psnr));
  REQUIRE(diff.perceptual);
  CHECK(diff.perceptual->displayed.ssim == Approx(1.0));
  CHECK(diff.perceptual->displayed.flip == 0.0);
  CHECK(diff.perceptual->hdr_flip == 0.0);
  CHECK(diff.perceptual->yee_pixels == 0);
  CHECK_THROWS_AS(diff_images(reference(), Image(8, 8), {}), Error);
}

TEST_CASE("Layers are chosen by name, summed, and bring their errors along", "[diff]") {
  Image image = testing::path_image(8, 4, testing::wavy, 0.25f);
  std::ranges::fill(image.add("ao.Y"), 0.5f);
  CHECK(select_layer(image, "").has("stderr.Y"));
  CHECK(select_layer(image, "indirect").channel("stderr.Y")[3] == 0.25f);
  const Image sum = select_layer(image, "direct+indirect");
  CHECK(sum.channel("G")[5] == Approx(image.channel("G")[5]));
  CHECK(!sum.has("stderr.Y"));
  CHECK(select_layer(image, "ao.Y").channel("B")[2] == 0.5f);
  CHECK_THROWS_AS(select_layer(image, "direct+nothing"), Error);
}

}  // namespace voxref
