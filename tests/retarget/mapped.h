// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <gtest/gtest.h>

#include "retarget/body_map.h"

namespace marey::retarget {

/// The map of a body that has one; the test fails when it has none.
inline BodyMap mapped(const Skeleton& skeleton) {
  Result<BodyMap> map = map_body(skeleton);
  EXPECT_TRUE(map) << (map ? "" : map.error().message());
  return *std::move(map);
}

}  // namespace marey::retarget
