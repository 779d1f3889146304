// colours.js: E as a place on the scale, and the colours there.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import {
  colourPosition,
  coloursOf,
  gradient,
  gradientStops,
  shareAt,
  themeColours,
  viridis,
} from '../../client/view/web/colours.js';
import { erosionScale, labelLegend, thicknessScale } from '../../client/view/web/overlay.js';

// van der Walt and Smith's first, middle and last colour; the middle one lies between two samples.
const kFirst = [68, 1, 84];
const kLast = [253, 231, 37];

test('the scale begins and ends with viridis, and stays there', () => {
  for (const t of [-1, 0]) assert.deepEqual(viridis(t), kFirst);
  for (const t of [1, 2]) assert.deepEqual(viridis(t), kLast);
});

test('between two samples colours are mixed', () => {
  const ninth = (k) => viridis(k / 9).map(Math.round);
  const [low, high] = [ninth(4), ninth(5)];
  viridis(0.5).forEach((value, c) => assert.ok(Math.abs(value - (low[c] + high[c]) / 2) < 1e-9));
  // What matplotlib says of the middle: 33, 145, 140.
  viridis(0.5).forEach((value, c) => assert.ok(Math.abs(value - [33, 145, 140][c]) < 3, `${value}`));
});

test('E stands where its cube root does', () => {
  assert.equal(colourPosition(0.125, 1), 0.5);
  assert.equal(colourPosition(-1, 1), 0);
  assert.equal(colourPosition(1, 0), 0);
  for (const share of [0, 0.01, 0.3]) assert.ok(Math.abs(shareAt(colourPosition(share, 0.3), 0.3) - share) < 1e-12);
});

test('one opaque colour for each value', () => {
  assert.deepEqual(Array.from(coloursOf([0, 8, 99], 8)), [...kFirst, 255, ...kLast, 255, ...kLast, 255]);
});

test('the gradient of the legend is lifted as the points are', () => {
  assert.equal(gradientStops(0).length, 10);
  assert.equal(gradientStops(0)[0], 'rgb(68,1,84)');
  assert.equal(gradientStops(0.5)[0], 'rgb(162,128,170)');
  assert.match(gradient(0), /^linear-gradient\(to right, rgb\(68,1,84\), .*, rgb\(253,231,37\)\)$/);
});

test('a dark theme and a light one', () => {
  assert.ok(themeColours('dark').background < themeColours('light').background);
  assert.equal(themeColours('light').lift, 0);
});

// The labels of a legend, and what stands above and below them.
function labelled(scale) {
  const labels = [];
  const ownerDocument = { createElement: () => ({}) };
  const replaceChildren = (...spans) => labels.splice(0, Infinity, ...spans.map(({ textContent }) => textContent));
  const parts = { '.heading': {}, '.note': {}, '.numbers': { ownerDocument, replaceChildren } };
  labelLegend({ querySelector: (selector) => parts[selector] }, scale);
  return { labels, heading: parts['.heading'].textContent, note: parts['.note'].textContent };
}

test('the legend tells per cent of v0 at equal distances of the cube root', () => {
  const legend = labelled(erosionScale({ highestShare: 0.064, scaleTitle: 'E', scaleNote: 'per cent' }));
  assert.deepEqual(legend, { labels: ['0', '0.1', '0.8', '2.7', '6.4'], heading: 'E', note: 'per cent' });
});

test('the legend tells thickness evenly', () => {
  assert.deepEqual(labelled(thicknessScale({ highest: 80, greatest: 80 })).labels, ['0', '20', '40', '60', '80']);
  assert.equal(labelled(thicknessScale({ highest: 80, greatest: 81 })).labels[4], '80+');
});
