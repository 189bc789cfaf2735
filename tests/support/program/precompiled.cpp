// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// This file is empty. Its target compiles the headers of marey_precompile() for all
// targets that reuse them.
