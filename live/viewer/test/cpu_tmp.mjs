import {execSync} from 'node:child_process';
import {openBrowser, openPage} from './browser.mjs';
import {MockServer} from './mock_server.mjs';
import {readdirSync, readFileSync} from 'node:fs';
const cpu = () => { // all chromium processes started by this node process
  const stats = readdirSync('/proc').filter((n) => /^\d+$/.test(n)).flatMap((n) => { try { const s = readFileSync(`/proc/${n}/stat`, 'utf8'); const cmd = s.slice(s.indexOf('(')+1, s.lastIndexOf(')')); const f = s.slice(s.lastIndexOf(')') + 2).split(' '); const a = readFileSync(`/proc/${n}/cmdline`,'utf8'); const kind=/--type=([a-z-]+)/.exec(a)?.[1] ?? 'main'; return [{pid:+n, ppid:+f[1], cmd, kind, ms: 10*(+f[11] + +f[12])}]; } catch { return []; } });
  const mine = new Set([process.pid]); let grew = true;
  while (grew) { grew = false; for (const p of stats) if (mine.has(p.ppid) && !mine.has(p.pid)) { mine.add(p.pid); grew = true; } }
  const out = {}; for (const p of stats) if (mine.has(p.pid) && p.pid !== process.pid) out[p.kind] = (out[p.kind] ?? 0) + p.ms;
  return out;
};
const browser = await openBrowser();
const server = new MockServer({mode: 'stage', rate_hz: 60, stage: +(process.argv[3] ?? 40)});
const {page} = await openPage(browser, await server.start(), {viewport: {width: 960, height: 600}});
if ((process.argv[2]??'').includes('n')) await page.evaluate(() => { window.mareyPage.stage.shown.names = false; });
if ((process.argv[2]??'').includes('h')) await page.evaluate(() => { for (const b of window.mareyPage.stage.bodies) b.object.visible=false, b.update=()=>{}; });
await page.evaluate(() => { window.mareyPage.stage.renderer.quality.second = () => false; });
await page.waitForTimeout(3000);
const a = cpu(); const d0 = await page.evaluate(() => window.mareyPage.drawnCount);
await page.waitForTimeout(15000);
const b = cpu(); const d1 = await page.evaluate(() => window.mareyPage.drawnCount);
const n = d1 - d0;
console.log(process.argv[2], n, 'pictures', Object.fromEntries(Object.keys(b).map((k) => [k, ((b[k] - (a[k] ?? 0)) / n).toFixed(1)])));
if (process.argv[4]) await page.screenshot({path: process.argv[4]});
await browser.close(); await server.stop();
