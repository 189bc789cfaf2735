// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#include "app/library/sources/licence.h"

#include <string_view>

#include "library/export/licence_terms.h"
#include <gtest/gtest.h>

namespace marey::app {
namespace {

TEST(Licence, EveryKnownLicenceHasTerms) {
  ASSERT_FALSE(known_licences().empty());
  for (const std::string_view licence : known_licences()) {
    EXPECT_TRUE(library::terms_of_licence(licence)) << licence;
    const auto spelled = spdx_licence(licence);
    ASSERT_TRUE(spelled) << spelled.error().message();
    EXPECT_EQ(*spelled, licence);
  }
}

}  // namespace
}  // namespace marey::app
