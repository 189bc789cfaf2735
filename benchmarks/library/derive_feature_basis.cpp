// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Derives the constants of library/features/feature_basis_table.cpp.
//
//   derive_feature_basis FOLDER [--cache FILE] > library/features/feature_basis_table.cpp
//   clang-format -i library/features/feature_basis_table.cpp
//
// FOLDER holds the BVH files of one data set. The basis is made of the 16 principal
// components of the features about their mean. Every content (the second word of a file's
// name) has the same weight, however many rows it has, so that walks do not outweigh all
// others. Every row also counts mirrored, so that a mirrored query is represented as well
// as the query. The share of the variance in the basis goes to the standard error stream.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "library/features/body_features.h"
#include "library/features/feature_basis.h"

#include "benchmarks/library/library_clips.h"

namespace marey {
namespace {

constexpr std::size_t kSize = library::kFeatureCount;
using Square = std::array<std::array<double, kSize>, kSize>;

struct Moments {
  double weight = 0.0;
  std::array<double, kSize> mean{};
  Square products{};

  void add(const float* row, double w) {
    weight += w;
    for (std::size_t a = 0; a < kSize; ++a) {
      mean[a] += w * row[a];
      for (std::size_t b = 0; b < kSize; ++b) {
        products[a][b] += w * row[a] * static_cast<double>(row[b]);
      }
    }
  }
  [[nodiscard]] Square covariance() const {
    Square out{};
    for (std::size_t a = 0; a < kSize; ++a) {
      for (std::size_t b = 0; b < kSize; ++b) {
        out[a][b] = products[a][b] / weight - mean[a] * mean[b] / weight / weight;
      }
    }
    return out;
  }
};

// Rotates rows and columns p and q of a symmetric matrix so that their product is 0.
void rotate(Square& m, Square& vectors, std::size_t p, std::size_t q) {
  if (std::abs(m[p][q]) < 1e-300) return;
  const double ratio = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
  const double t =
      (ratio >= 0.0 ? 1.0 : -1.0) / (std::abs(ratio) + std::sqrt(ratio * ratio + 1.0));
  const double c = 1.0 / std::sqrt(t * t + 1.0);
  const double s = t * c;
  for (std::size_t k = 0; k < kSize; ++k) {
    const double a = m[k][p];
    const double b = m[k][q];
    m[k][p] = c * a - s * b;
    m[k][q] = s * a + c * b;
  }
  for (std::size_t k = 0; k < kSize; ++k) {
    const double a = m[p][k];
    const double b = m[q][k];
    m[p][k] = c * a - s * b;
    m[q][k] = s * a + c * b;
  }
  for (std::size_t k = 0; k < kSize; ++k) {
    const double a = vectors[k][p];
    const double b = vectors[k][q];
    vectors[k][p] = c * a - s * b;
    vectors[k][q] = s * a + c * b;
  }
}

void print_row(const std::array<double, kSize>& row) {
  std::printf("    {{");
  for (std::size_t k = 0; k < kSize; ++k) {
    if (k > 0) std::printf(k % 6 == 0 ? ",\n      " : ", ");
    std::printf("%.7fF", row[k]);
  }
  std::printf("}},\n");
}

void print_basis(const Square& vectors, const std::vector<std::size_t>& order) {
  std::printf(
      "// SPDX-FileCopyrightText: The marey authors\n"
      "// SPDX-License-Identifier: Apache-2.0\n"
      "#include \"library/features/feature_basis.h\"\n\n"
      "namespace marey::library {\n"
      "namespace {\n\n"
      "// Written by benchmarks/library/derive_feature_basis.cpp.\n"
      "constexpr FeatureBasis kBasis = {{\n");
  for (std::size_t d = 0; d < library::kBasisCount; ++d) {
    std::array<double, kSize> row{};
    for (std::size_t k = 0; k < kSize; ++k) row[k] = vectors[k][order[d]];
    // The sign of a component is arbitrary: its largest number is positive.
    const auto largest = std::max_element(row.begin(), row.end(), [](double a, double b) {
      return std::abs(a) < std::abs(b);
    });
    const double sign = *largest < 0.0 ? -1.0 : 1.0;
    for (double& v : row) v = std::abs(v) < 5e-8 ? 0.0 : sign * v;
    print_row(row);
  }
  std::printf(
      "}};\n\n"
      "}  // namespace\n\n"
      "const FeatureBasis& feature_basis() { return kBasis; }\n\n"
      "}  // namespace marey::library\n");
}

int run(const std::vector<BenchmarkClip>& clips) {
  std::map<std::string, int> rows_of_content;
  for (const BenchmarkClip& clip : clips) {
    rows_of_content[word_of(clip.name, 1)] += clip.count();
  }
  Moments moments;
  for (const BenchmarkClip& clip : clips) {
    const double weight = 1.0 / rows_of_content[word_of(clip.name, 1)];
    const std::vector<float> mirrored = library::mirrored_features(clip.rows);
    for (std::size_t k = 0; k < clip.rows.size(); k += library::kFeatureStride) {
      moments.add(clip.rows.data() + k, weight);
      moments.add(mirrored.data() + k, weight);
    }
  }
  Square m = moments.covariance();
  Square vectors{};
  for (std::size_t k = 0; k < kSize; ++k) vectors[k][k] = 1.0;
  for (int sweep = 0; sweep < 60; ++sweep) {
    for (std::size_t p = 0; p < kSize; ++p) {
      for (std::size_t q = p + 1; q < kSize; ++q) rotate(m, vectors, p, q);
    }
  }
  std::vector<std::size_t> order(kSize);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return m[a][a] > m[b][b];
  });
  double all = 0.0;
  double kept = 0.0;
  for (std::size_t k = 0; k < kSize; ++k) {
    all += m[order[k]][order[k]];
    if (k < library::kBasisCount) kept += m[order[k]][order[k]];
  }
  print_basis(vectors, order);
  std::fprintf(stderr,
               "%zu clips, %zu contents, share of the variance %.4f\n",
               clips.size(),
               rows_of_content.size(),
               kept / all);
  return 0;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  if (argc != 2 && !(argc == 4 && std::strcmp(argv[2], "--cache") == 0)) {
    std::fprintf(stderr, "usage: derive_feature_basis FOLDER [--cache FILE]\n");
    return 2;
  }
  const auto files = marey::files_below(argv[1], ".bvh");
  return marey::run(marey::read_clips(files, argc == 4 ? argv[3] : ""));
}
