// Opens a report page in headless Chromium and says, as one JSON object, what came of it.
//
//   node page.mjs REPORT.html                     tries it: turns the first viewer by mouse, keys and finger, changes colours,
//                                                 listens for trouble
//   node page.mjs REPORT.html PICTURES            also leaves pictures of it in that directory: both themes, wide and narrow
import { pathToFileURL } from 'node:url';
import puppeteer from 'puppeteer-core';

const [file, pictures] = process.argv.slice(2);
const address = pathToFileURL(file).href;
const found = { requests: [], console: [], dialogs: 0 };
const PHONE = { width: 390, height: 844, isMobile: true, hasTouch: true };

const browser = await puppeteer.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
  // Drawn in software, as on any machine without a graphics card; root has no other sandbox.
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--hide-scrollbars'],
});
try {
  const page = await listened();
  await page.setViewport({ width: 1280, height: 900 });
  await opened(page);

  found.title = await page.title();
  found.heading = await page.$eval('h1', (heading) => heading.textContent);
  found.injected = (await page.$$('img:not([src^="data:"])')).length;
  found.broken = await page.$$eval('img', (images) => images.filter((image) => image.naturalWidth === 0).length);
  found.paper = { light: await paper(page) };
  found.views = {};
  if (await page.$('.viewer')) await turnModels(page);

  await page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: 'dark' }]);
  found.paper.dark = await paper(page);
  await page.click('.themes input[value=light]');
  found.paper.chosen = await paper(page);
  if (pictures) await takePictures(page, 'wide', pictures);

  // From here on the first page stands behind and draws nothing.
  const phone = await listened();
  await phone.setViewport(PHONE);
  await opened(phone);
  found.phone = { wider: await phone.evaluate(() => document.documentElement.scrollWidth - innerWidth) };
  if (await phone.$('.viewer')) await touch(phone);
  if (pictures) await takePictures(phone, 'phone', pictures);
} finally {
  await browser.close();
}
console.log(JSON.stringify(found));

/** A page whose troubles are noted. */
async function listened() {
  const page = await browser.newPage();
  // No request leaves the page, whatever it tries: all but the page itself and what it carries is noted and refused.
  await page.setRequestInterception(true);
  page.on('request', (request) => {
    const carried = request.url() === address || /^(data|blob):/.test(request.url());
    if (!carried) found.requests.push(request.url());
    return carried ? request.continue() : request.abort();
  });
  page.on('console', (message) => {
    // A hint to who reads pixels back, which only this script does.
    if (message.text().startsWith('Canvas2D: Multiple readback')) return;
    if (['error', 'warn'].includes(message.type())) found.console.push(message.text());
  });
  page.on('pageerror', (error) => found.console.push(String(error)));
  page.on('dialog', (dialog) => { found.dialogs += 1; return dialog.dismiss(); });
  return page;
}

/** Opens the report and waits until all models are drawn. */
async function opened(page) {
  await page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: 'light' }]);
  await page.goto(address);
  await page.waitForFunction(() => !document.querySelector('[aria-busy=true]'), { timeout: 20_000 });
  await settled(page);
}

/** Uses mouse, keyboard and switches on the first viewer. */
async function turnModels(page) {
  found.views.first = await views(page);
  const canvas = await page.$('.pane canvas');
  await canvas.scrollIntoView();
  const { x, y, width, height } = await canvas.boundingBox();
  await page.mouse.move(x + width / 2, y + height / 2);
  await page.mouse.down();
  await page.mouse.move(x + width / 2 + 120, y + height / 2 + 30, { steps: 4 });
  await page.mouse.up();
  await settled(page);
  found.views.dragged = await views(page);

  // From the top of the page the Tab key reaches the first view; a click has put the focus there already otherwise.
  await page.evaluate(() => document.activeElement.blur());
  await page.$eval('[name=reset]', (button) => button.click());
  await settled(page);
  found.views.reset = await views(page);
  await page.focus('[name=reset]');
  await page.keyboard.press('Tab');
  found.focused = await page.evaluate(() => document.activeElement.tagName);
  await page.keyboard.press('ArrowLeft');
  await settled(page);
  found.views.arrow = await views(page);
  await page.keyboard.press('Home');
  await page.$eval('[name=heat]', (box) => box.click());
  await settled(page);
  found.views.plain = await views(page);
  await page.$eval('[name=heat]', (box) => box.click());
  await page.$eval('[name=edges]', (box) => box.click());
  await settled(page);
  found.views.edges = await views(page);
  await page.$eval('[name=edges]', (box) => box.click());

  const up = (value) => page.$eval(`[name^=up-][value="${value}"]`, (choice) => choice.click());
  const given = await page.$eval('[name^=up-]:checked', (choice) => choice.value);
  await up('0 1 0');
  await settled(page);
  found.views.up = await views(page);
  await page.keyboard.press('ArrowUp');
  await settled(page);
  found.views.upTurned = await views(page);
  await up(given);
  await settled(page);
  found.views.upAgain = await views(page);
}

/** Drags a finger up, first on a view, then on its name: one turns, the other scrolls. */
async function touch(page) {
  const drag = async (selector) => {
    const place = await page.$(selector);
    await place.scrollIntoView();
    const { x, y, width, height } = await place.boundingBox();
    const before = await page.evaluate(() => scrollY);
    const shown = await views(page);
    await page.touchscreen.touchStart(x + width / 2, y + height / 2);
    for (const step of [20, 40, 60, 80]) await page.touchscreen.touchMove(x + width / 2, y + height / 2 - step);
    await page.touchscreen.touchEnd();
    await settled(page);
    const after = await views(page);
    const turned = after.filter((view, index) => view.sum !== shown[index].sum).length;
    return { turned, scrolled: Math.abs(await page.evaluate(() => scrollY) - before) };
  };
  found.phone.onView = await drag('.pane canvas');
  found.phone.beside = await drag('.pane figcaption');
  found.phone.tallest = await page.$$eval('.pane canvas', (all) => Math.max(...all.map((c) => c.clientHeight / innerHeight)));
  await page.$eval('[name=reset]', (button) => button.click());
}

/** Two frames later everything that was asked for is drawn. */
function settled(page) {
  return page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

/** The colour behind the page. */
function paper(page) {
  return page.evaluate(() => getComputedStyle(document.documentElement).backgroundColor);
}

/** Of every view: a number that changes with its pixels, how many of them are drawn on, and how many colours they have. */
function views(page) {
  return page.$$eval('.pane canvas', (canvases) => canvases.map((canvas) => {
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    const colours = new Set();
    let drawn = 0;
    let sum = 0;
    for (let at = 0; at < data.length; at += 4) {
      if (data[at + 3] === 0) continue;
      const colour = (data[at] << 16) | (data[at + 1] << 8) | data[at + 2];
      colours.add(colour);
      drawn += 1;
      sum = (Math.imul(sum, 31) + colour + at) | 0;
    }
    return { sum, drawn: drawn / (canvas.width * canvas.height), colours: colours.size };
  }));
}

async function takePictures(page, name, folder) {
  await page.click('.themes input[value=""]');
  for (const theme of ['light', 'dark']) {
    await page.emulateMediaFeatures([{ name: 'prefers-color-scheme', value: theme }]);
    await settled(page);
    await page.screenshot({ path: `${folder}/${theme}-${name}.png`, fullPage: true });
  }
}
