// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "core/finding.h"

#include <gtest/gtest.h>

namespace marey {
namespace {

TEST(Finding, IsOneLine) {
  EXPECT_EQ(poor_finding("tilt", "camera left", "it sees 3 views", "tilt it").message(),
            "camera left: it sees 3 views. Next: tilt it.");
  EXPECT_EQ(fair_finding("floor", "", "it is bent").message(), "it is bent.");
}

TEST(Finding, IsAQualityErrorUnlessAnErrorWasTolerated) {
  EXPECT_EQ(poor_finding("tilt", "a", "b", "c").error().code, Errc::kQuality);
  const Error lost{Errc::kDevice, "disk", "it is full", "free space"};
  const Finding finding = tolerated(Severity::kPoor, "trial", lost);
  EXPECT_EQ(finding.error().code, Errc::kDevice);
  EXPECT_EQ(finding.message(), lost.message());
}

}  // namespace
}  // namespace marey
