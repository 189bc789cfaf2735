// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// Empty: the headers of marey_precompile() are compiled beside it, for all who reuse
// them.
