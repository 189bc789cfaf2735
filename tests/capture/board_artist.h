// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <glm/vec2.hpp>
#include <opencv2/core.hpp>

#include "core/board.h"

namespace marey::tests {

/// A board in an image: its outer corners, bottom left, bottom right, top right, top left
/// of the upright board, pixel centres at integers. [px]
using BoardPlace = std::array<glm::dvec2, 4>;

/// Returns a flat image of the upright board, 60 px a square, with a margin of one white
/// square. ChArUco boards are drawn by OpenCV itself, except those of the old pattern.
[[nodiscard]] cv::Mat flat_picture(const CharucoBoard& board);
[[nodiscard]] cv::Mat flat_picture(const Chessboard& board);

/// Returns a grey image with the board: each pixel is the mean of the light on it.
[[nodiscard]] cv::Mat draw_board(const cv::Mat& flat,
                                 int width_px,
                                 int height_px,
                                 const BoardPlace& place);

/// Returns the position of an inner corner of a board of `rows` by `columns` squares in
/// such an image.
[[nodiscard]] glm::dvec2 true_corner_px(int rows,
                                        int columns,
                                        int point,
                                        const BoardPlace& place);

}  // namespace marey::tests
