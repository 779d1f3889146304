// The ticks of the box (ticked_box.js) and their numbers (ticks.js), seen by a camera along z.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { OrthographicCamera } from 'three';
import { TickedBox } from '../../client/view/web/ticked_box.js';
import { TickNumbers } from '../../client/view/web/ticks.js';
import { fakeElement } from './fake_document.js';

// From the front: x to the right, y up; one page unit is half of the canvas.
function camera() {
  const made = new OrthographicCamera(-1, 1, 1, -1, 1, 20);
  made.position.set(0, 0, 10);
  made.updateMatrixWorld();
  made.matrixWorldInverse.getInverse(made.matrixWorld);
  return made;
}

// A canvas in which every number has a size.
function container(width, height, size) {
  const made = Object.assign(fakeElement(), { clientWidth: width, clientHeight: height });
  made.ownerDocument = {
    createElement: (name) => Object.assign(fakeElement(name), { offsetWidth: size[0], offsetHeight: size[1] }),
  };
  return made;
}

test('ticks stand at round coordinates, six to sixteen along the longest side', () => {
  for (const unit of [0.0013, 0.5, 1, 7, 12.5, 4e6]) {
    const { tickDistance, ticks } = new TickedBox([0.5, 1, 0.25], [0, 3 * unit, 0], unit);
    const [mantissa] = tickDistance.toExponential(6).split('e');
    assert.ok(['1', '2', '5'].includes(String(Number(mantissa))), `${tickDistance}`);
    assert.ok(ticks[1].length >= 6 && ticks[1].length <= 16, `${ticks[1].length} at unit ${unit}`);
    for (const { coordinate, index, at } of ticks[1]) {
      assert.ok(Math.abs(coordinate - index * tickDistance) < 1e-9 * unit);
      assert.ok(Math.abs(3 * unit + at * unit - coordinate) < 1e-9 * unit);
      assert.ok(Math.abs(at) <= 1 + 1e-9);
    }
  }
});

test('both ends of a side have ticks where they are round', () => {
  const { tickDistance, ticks } = new TickedBox([1, 0.5, 0], [1, -3, 0.3], 1.5);
  assert.equal(tickDistance, 0.5);
  assert.deepEqual(ticks[0].map(({ coordinate }) => coordinate), [-0.5, 0, 0.5, 1, 1.5, 2, 2.5]);
  assert.deepEqual(ticks[1].map(({ coordinate }) => coordinate), [-3.5, -3, -2.5]);
  assert.deepEqual(ticks[2], []);
});

test('ticks lie on the lowest edge, and the leftmost of an upright axis', () => {
  const box = new TickedBox([1, 0.5, 0.25], [0, 0, 0], 1);
  box.look(camera());
  const [x, y, z] = box.edges;
  assert.equal(x.foot[1], -0.5);
  assert.ok(x.tick[1] < 0);
  assert.ok(x.outward[1] < 0);
  assert.equal(y.foot[0], -1);
  assert.ok(y.tick[0] < 0);
  assert.ok(y.outward[0] < 0);
  assert.equal(z, null, 'it points at the viewer');
  const marks = box.marks.geometry.getAttribute('position');
  assert.equal(marks.count, 2 * (box.ticks[0].length + box.ticks[1].length));
  assert.deepEqual(box.placeOn(x, 0, 0.75).slice(0, 2), [0.75, -0.5]);
});

// The texts of the numbers that are seen, by axis.
function seenOf(size, pixels, half = 0.9) {
  const box = new TickedBox([half, half, 0.1], [0, 0, 0], 1);
  const room = container(2 * pixels, 2 * pixels, size);
  const numbers = new TickNumbers(room, box);
  const eye = camera();
  box.look(eye);
  numbers.place(eye, pixels);
  const seen = numbers.spans.map((spans) => spans.filter((span) => !span.hidden).map((span) => span.textContent));
  return { numbers, seen };
}

test('every tick has its number where there is room', () => {
  const { numbers, seen } = seenOf([20, 10], 500);
  assert.deepEqual(seen[0], ['−0.8', '−0.6', '−0.4', '−0.2', '0', '0.2', '0.4', '0.6', '0.8']);
  assert.deepEqual(seen[2], []);
  assert.equal(numbers.widest(), 20);
  // 0 of x: in the middle, below the edge at 0.9 by its tick, the gap and half its height.
  assert.match(numbers.spans[0][4].style.transform, /^translate\(490\.0px, 969\.0px\)$/);
});

test('where there is none, every second, fifth or tenth has', () => {
  assert.deepEqual(seenOf([50, 10], 200).seen[0], ['−0.8', '−0.4', '0', '0.4', '0.8']);
  assert.deepEqual(seenOf([100, 10], 200).seen[0].slice(-1), ['0']);
});

test('no number covers another', () => {
  const { numbers } = seenOf([60, 60], 350, 1); // both sides have a tick at their corner
  const middles = numbers.spans
    .flat()
    .filter((span) => !span.hidden)
    .map((span) => span.style.transform.match(/-?[\d.]+/g).map(Number));
  assert.equal(middles.length, numbers.spans.flat().length - 2, 'one at the corner, and z has one');
  middles.forEach(([x, y], i) => {
    for (const [u, v] of middles.slice(0, i)) assert.ok(Math.abs(x - u) >= 60 || Math.abs(y - v) >= 60);
  });
});
