// SPDX-FileCopyrightText: The marey authors
// SPDX-License-Identifier: Apache-2.0

// A headless browser that renders in software, and its errors.

import {existsSync} from 'node:fs';
import {missingPackages, pageFolder} from './installed.mjs';

const CHROMIUM = process.env.CHROMIUM ?? '/usr/bin/chromium';

/** The reason why a browser or its page is missing; null if both exist. `built`: the page
 *  is wanted from its folder. */
export function missing({built = true} = {}) {
  const packages = missingPackages();
  if (packages) return packages;
  if (built && !existsSync(`${pageFolder}page.js`)) {
    return 'the page is not built; npm run build --prefix live/viewer';
  }
  if (!existsSync(CHROMIUM)) return 'chromium is missing; apt-get install chromium';
  return null;
}

export async function openBrowser() {
  const {chromium} = await import('playwright-core');
  return chromium.launch({executablePath: CHROMIUM, args: ['--no-sandbox',
    '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader']});
}

/** A page at this address. `troubles` collects errors and requests that leave the server. */
export async function openPage(browser, address, options = {}) {
  const context = await browser.newContext({viewport: {width: 960, height: 600}, ...options});
  const page = await context.newPage();
  const troubles = [];
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type())) troubles.push(message.text());
  });
  page.on('pageerror', (error) => troubles.push(error.message));
  page.on('request', (request) => {
    if (!request.url().startsWith(address) && !/^(blob|data):/.test(request.url())) {
      troubles.push(`asks for ${request.url()}`);
    }
  });
  await page.goto(address);
  // The page received data and drew it.
  await page.waitForFunction(() => window.mareyPage?.stage.bodies.some((body) => body.present));
  return {page, troubles, close: () => context.close()};
}
