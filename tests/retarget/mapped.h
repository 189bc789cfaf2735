// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>

#include <gtest/gtest.h>

#include "retarget/body/body_map.h"

namespace marey::retarget {

/// Returns the map of a body; the test fails if it has none.
inline BodyMap mapped(const Skeleton& skeleton) {
  Result<BodyMap> map = map_body(skeleton);
  EXPECT_TRUE(map) << (map ? "" : map.error().message());
  return *std::move(map);
}

}  // namespace marey::retarget
