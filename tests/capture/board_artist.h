// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include <glm/vec2.hpp>
#include <opencv2/core.hpp>

#include "core/board.h"

namespace marey::tests {

/// A board in a picture: where its outer corners are, bottom left, bottom right, top
/// right, top left of the upright board, pixel centres at integers. [px]
using BoardPlace = std::array<glm::dvec2, 4>;

/// A flat picture of the upright board, 60 px a square, a square of white around it.
/// ChArUco boards are drawn by OpenCV itself, except those in the old manner.
[[nodiscard]] cv::Mat flat_picture(const CharucoBoard& board);
[[nodiscard]] cv::Mat flat_picture(const Chessboard& board);

/// A grey picture with the board in it: each pixel the mean of the light that falls on
/// it.
[[nodiscard]] cv::Mat draw_board(const cv::Mat& flat,
                                 int width_px,
                                 int height_px,
                                 const BoardPlace& place);

/// Where an inner corner of a board of `rows` by `columns` squares is in such a picture.
[[nodiscard]] glm::dvec2 true_corner_px(int rows,
                                        int columns,
                                        int point,
                                        const BoardPlace& place);

}  // namespace marey::tests
