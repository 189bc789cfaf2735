// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "reconstruct/tags/soft_tissue_noise.h"

#include <random>

#include <gtest/gtest.h>

namespace marey::reconstruct {
namespace {

using Residuals = Eigen::Matrix<double, 8, 1>;
using Jacobian = Eigen::Matrix<double, 8, Eigen::Dynamic>;

/// Sightings of tags that slip by `true_m`, solved with an assumed slip of `guess_m`.
class SlippingTags {
 public:
  explicit SlippingTags(std::uint64_t seed) : random_(seed) {}

  void see(HumanBone bone,
           int times,
           double true_m,
           double guess_m,
           double cameras,
           SlipEstimate& estimate) {
    TagSlip slip;
    slip.directions = Eigen::Matrix<double, 8, 3>::Identity();
    // A tag at three metres: a tenth of a pixel is 0.2 mm across and 4 mm along the ray.
    slip.gains = {5000.0, 5000.0, 250.0};
    slip.sigma_m = guess_m;
    slip.cameras = cameras;
    for (int i = 0; i < times; ++i) {
      const Eigen::Vector3d slips{draw() * true_m, draw() * true_m, draw() * true_m};
      for (int c = 0; c < static_cast<int>(cameras); ++c) {
        Residuals residuals;
        for (double& r : residuals) r = draw();
        residuals.head<3>() += (slip.gains.array() * slips.array()).matrix();
        residuals.head<3>().array() /= slip.stretch();
        estimate.add(bone, slip, residuals, Jacobian(8, 0), Eigen::MatrixXd(0, 0));
      }
    }
  }

 private:
  double draw() { return normal_(random_); }
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

SlipSigmas all(double sigma_m) {
  SlipSigmas sigmas{};
  sigmas.fill(sigma_m);
  return sigmas;
}

TEST(SlipEstimate, FindsHowFarTagsSlipFromAGuessThatIsTooSmall) {
  constexpr double kTrueM = 0.003;
  SlippingTags tags(1);
  SlipSigmas sigmas = all(0.0005);
  for (int pass = 0; pass < 6; ++pass) {
    SlipEstimate estimate;
    for (const HumanBone bone : human_bones()) {
      tags.see(bone, 200, kTrueM, sigmas[index(bone)], 1.0, estimate);
    }
    sigmas = estimate.improved(sigmas);
  }
  // 400 numbers across the ray determine a sigma to 3.5 %; four of those.
  for (const double sigma_m : sigmas) EXPECT_NEAR(sigma_m, kTrueM, 0.14 * kTrueM);
}

TEST(SlipEstimate, IsNotMisledByCamerasThatSeeTheSameSlip) {
  constexpr double kTrueM = 0.002;
  SlippingTags tags(2);
  SlipSigmas sigmas = all(0.002);
  for (int pass = 0; pass < 4; ++pass) {
    SlipEstimate estimate;
    tags.see(
        HumanBone::kHips, 1000, kTrueM, sigmas[index(HumanBone::kHips)], 3.0, estimate);
    sigmas = estimate.improved(sigmas);
  }
  EXPECT_NEAR(sigmas[index(HumanBone::kHips)], kTrueM, 0.1 * kTrueM);
}

TEST(SlipEstimate, FindsNextToNoneInTagsThatAreRigid) {
  SlippingTags tags(3);
  SlipSigmas sigmas = all(0.001);
  for (int pass = 0; pass < 6; ++pass) {
    SlipEstimate estimate;
    for (const HumanBone bone : human_bones()) {
      tags.see(bone, 200, 0.0, sigmas[index(bone)], 1.0, estimate);
    }
    sigmas = estimate.improved(sigmas);
  }
  // Corners alone determine the tag to 0.2 mm.
  for (const double sigma_m : sigmas) EXPECT_LT(sigma_m, 0.0001);
}

TEST(SlipEstimate, TakesASegmentThatIsHardlySeenToSlipLikeTheOthers) {
  SlippingTags tags(4);
  SlipEstimate estimate;
  tags.see(HumanBone::kHips, 1000, 0.002, 0.002, 1.0, estimate);
  tags.see(HumanBone::kHead, 1, 0.0, 0.002, 1.0, estimate);
  const SlipSigmas sigmas = estimate.improved(all(0.002));
  EXPECT_NEAR(sigmas[index(HumanBone::kHead)], 0.002, 0.0003);
  EXPECT_NEAR(sigmas[index(HumanBone::kLeftFoot)], 0.002, 0.0003);
}

TEST(SlipEstimate, KeepsItsGuessWhereNothingIsSeen) {
  EXPECT_EQ(SlipEstimate().improved(all(0.001)), all(0.001));
  EXPECT_EQ(SlipEstimate().scale(), 1.0);
}

}  // namespace
}  // namespace marey::reconstruct
