#include "reference/sampler.h"

#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "catch.h"
#include "reference/chi_square.h"

namespace voxref {

namespace {
constexpr std::array<uint64_t, 3> keys = {1, 0x123456789abcdefu, ~0ull};
}  // namespace

TEST_CASE("The second Sobol coordinate is Pascal's triangle modulo 2 times the index", "[sampler]") {
  // Row i, column j of the generator matrix holds C(j,i) mod 2, by the recurrence of the triangle.
  std::array<std::array<int, 32>, 32> matrix{};
  for (int j = 0; j < 32; ++j)
    for (int i = 0; i <= j; ++i) matrix[i][j] = (i == 0 || i == j) ? 1 : (matrix[i][j - 1] + matrix[i - 1][j - 1]) % 2;
  for (uint32_t index : {0u, 1u, 2u, 3u, 12u, 255u, 0x12345678u, 0xdeadbeefu, 0xffffffffu}) {
    uint32_t expected = 0;
    for (int i = 0; i < 32; ++i) {
      int parity = 0;
      for (int j = 0; j < 32; ++j) parity ^= matrix[i][j] & static_cast<int>(index >> j & 1);
      expected |= static_cast<uint32_t>(parity) << i;
    }
    CHECK(sobol_second_reversed(index) == expected);
  }
}

TEST_CASE("Every aligned block of 2^k one-dimensional samples has one in each of 2^k strata", "[sampler]") {
  for (const uint64_t key : keys)
    for (const uint32_t dimension : {0u, 5u, 1000u})
      for (const uint32_t k : {0u, 1u, 4u, 8u})
        for (const uint32_t block : {0u, 3u}) {
          std::set<uint32_t> strata;
          for (uint32_t i = 0; i < 1u << k; ++i) {
            const Sampler sampler(key, (block << k) + i);
            strata.insert(
                static_cast<uint32_t>(std::floor(std::ldexp(sampler.get_1d(dimension), static_cast<int>(k)))));
          }
          CHECK(strata.size() == 1u << k);
        }
}

TEST_CASE("Every aligned block of 2^k two-dimensional samples is a (0,k,2)-net", "[sampler]") {
  for (const uint64_t key : keys)
    for (const uint32_t dimension : {0u, 7u})
      for (const int k : {0, 1, 2, 5, 8})
        for (const uint32_t block : {0u, 5u})
          for (int across = 0; across <= k; ++across) {
            std::set<std::pair<int, int>> cells;
            for (uint32_t i = 0; i < 1u << k; ++i) {
              const glm::vec2 p = Sampler(key, (block << k) + i).get_2d(dimension);
              cells.insert({static_cast<int>(std::ldexp(p.x, across)), static_cast<int>(std::ldexp(p.y, k - across))});
            }
            CHECK(cells.size() == size_t{1} << k);
          }
}

TEST_CASE("Pairs of samples are uniform over dimension sets, randomizations, pixels and seeds", "[sampler]") {
  // What is paired must be independent: any correlation shows as an uneven 16 x 16 histogram. Six tests at 0.1 % each;
  // a bin 7 % off everywhere (one in 16 pairs correlated) would be seen.
  constexpr int side = 16, count = 1 << 16;
  const auto p_value = [](auto pair) {
    std::vector<double> observed(side * side), expected(side * side, static_cast<double>(count) / (side * side));
    for (uint32_t i = 0; i < count; ++i) {
      const glm::vec2 p = pair(i);
      REQUIRE((p.x >= 0.0f && p.x < 1.0f && p.y >= 0.0f && p.y < 1.0f));
      observed[static_cast<size_t>(static_cast<int>(p.x * side) * side + static_cast<int>(p.y * side))] += 1.0;
    }
    return chi_square_p(observed, expected);
  };
  constexpr double significance = 0.001;
  CHECK(p_value([](uint32_t i) {  // two sets of the same point
          const Sampler sampler(randomization_key(1, i, 0, 0), 3);
          return glm::vec2(sampler.get_1d(4), sampler.get_1d(5));
        }) > significance);
  CHECK(p_value([](uint32_t i) {  // the two halves of a pair, over pixels
          return Sampler(randomization_key(2, i % 256, i / 256, 0), 0).get_2d(1);
        }) > significance);
  CHECK(p_value([](uint32_t i) {  // neighbouring pixels
          return glm::vec2(Sampler(randomization_key(3, 2 * i, 7, 0), 0).get_1d(2),
                           Sampler(randomization_key(3, 2 * i + 1, 7, 0), 0).get_1d(2));
        }) > significance);
  CHECK(p_value([](uint32_t i) {  // the same pixel's next randomization
          return glm::vec2(Sampler(randomization_key(4, 9, 9, 2 * i), 1).get_2d(2).y,
                           Sampler(randomization_key(4, 9, 9, 2 * i + 1), 1).get_2d(2).y);
        }) > significance);
  CHECK(p_value([](uint32_t i) {  // consecutive seeds
          return glm::vec2(Sampler(randomization_key(2 * i, 9, 9, 0), 0).get_1d(0),
                           Sampler(randomization_key(2 * i + 1, 9, 9, 0), 0).get_1d(0));
        }) > significance);
  CHECK(p_value([](uint32_t i) {  // a number of one set with half a pair of another
          const Sampler sampler(randomization_key(5, i, 1, 0), 6);
          return glm::vec2(sampler.get_2d(3).x, sampler.get_1d(2));
        }) > significance);
}

}  // namespace voxref
