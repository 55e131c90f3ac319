// A reader's browser: opens a report that lies in a file and complains of what a console would.
import assert from 'node:assert/strict';
import {existsSync, statSync} from 'node:fs';
import {chromium} from 'playwright-core';

const program = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find(existsSync);
if (!program) {
  console.log('skipped: chromium is not installed');
  process.exit(77);
}
const page = process.argv[2];
assert(statSync(page).size < 10e6, 'a page stays under 10 MB');
export const browser = await chromium.launch({executablePath: program, args: ['--no-sandbox']});

export async function opened(colorScheme) {
  const tab = await browser.newPage({viewport: {width: 1400, height: 900}, colorScheme});
  const wrong = [];
  tab.on('console', message => message.type() === 'error' && wrong.push(message.text()));
  tab.on('pageerror', error => wrong.push(error.stack));
  tab.on('request', request => /^(file|data|blob):/.test(request.url()) || wrong.push(`asks for ${request.url()}`));
  await tab.goto('file://' + page);
  await tab.waitForSelector('body[data-ready]', {timeout: 20000});
  assert.deepEqual(wrong, []);
  return [tab, wrong];
}

