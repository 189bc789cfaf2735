// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// npm run serve [-- file]: serves the page with the mock server, for manual tests.

import {MockServer} from './mock_server.mjs';

const mode = process.argv[2] === 'file' ? 'file' : 'live';
console.log(await new MockServer({mode}).start(8123));
