// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include <opencv2/core.hpp>

// Private to capture.
namespace marey::capture {

enum class ImageColours { kGrey, kBgr };

/// Decodes a PNG with libpng; transparency is left out, 16 bits become 8. Empty if it is
/// none, or damaged. Precondition: its header states a size that memory can hold.
[[nodiscard]] cv::Mat decode_png(std::span<const unsigned char> bytes,
                                 ImageColours colours);

}  // namespace marey::capture
