// decode.js against bytes that are written here, number by number.
/* eslint-env node */
import assert from 'node:assert/strict';
import { test } from 'node:test';
import {
  decodePage,
  descending,
  erodedPositions,
  meshPositions,
  pointPositions,
  prefixLength,
} from '../../client/view/web/decode.js';

// A page with these facts and bytes.
const pageOf = (facts, bytes) => {
  const texts = { facts: JSON.stringify(facts), arrays: `\n${Buffer.from(bytes).toString('base64')}\n` };
  return { getElementById: (id) => ({ textContent: texts[id] }) };
};

test('numbers of every type are read where the directory says, low byte first', () => {
  const bytes = [
    ...[0x01, 0x02, 0xff, 0xff], // u16: 0x0201, 65535
    ...[0x04, 0x03, 0x02, 0x81], // u32: 0x81020304
    ...[0x00, 0x00, 0xc0, 0x3f, 0x00, 0x00, 0x00, 0xc0], // f32: 1.5, -2
    ...[0x7f, 0x81, 0x00, 0xff], // i8: 127, -127, 0, -1
  ];
  const arrays = { a: ['u16', 0, 2], b: ['u32', 4, 1], c: ['f32', 8, 2], d: ['i8', 16, 4], none: ['f32', 20, 0] };
  const page = decodePage(pageOf({ unit: 3, models: [{ name: 'body', arrays }] }, bytes));
  assert.equal(page.unit, 3);
  assert.equal(page.models[0].name, 'body');
  const read = page.models[0].arrays;
  assert.deepEqual(Array.from(read.a), [0x0201, 65535]);
  assert.deepEqual(Array.from(read.b), [0x81020304]);
  assert.deepEqual(Array.from(read.c), [1.5, -2]);
  assert.deepEqual(Array.from(read.d), [127, -127, 0, -1]);
  assert.equal(read.none.length, 0);
});

test('each model has arrays of its own in the one block', () => {
  const models = [{ arrays: { a: ['i8', 0, 1] } }, { arrays: { a: ['i8', 4, 1] } }];
  const page = decodePage(pageOf({ models }, [5, 0, 0, 0, 7]));
  assert.deepEqual(page.models.map(({ arrays }) => arrays.a[0]), [5, 7]);
});

test('an array that is not wholly there is refused', () => {
  assert.throws(() => decodePage(pageOf({ models: [{ arrays: { a: ['f32', 0, 2] } }] }, [0, 0, 0, 0])), RangeError);
});

test('positions are steps along the three axes from the origin', () => {
  const grid = { origin: [-1, -0.5, 0], axes: [[0.5, 0, 0], [0.25, 1, 0], [0, 0, 2]] };
  const steps = Uint16Array.from([0, 0, 0, 2, 1, 3]);
  const expected = [-1, -0.5, 0, 0.25, 0.5, 6];
  assert.deepEqual(Array.from(meshPositions({ arrays: { meshSteps: steps }, meshGrid: grid })), expected);
  assert.deepEqual(Array.from(pointPositions({ arrays: { pointSteps: steps }, pointGrid: grid })), expected);
  assert.deepEqual(Array.from(erodedPositions({ arrays: { eroded2Steps: steps }, meshGrid: grid }, 2)), expected);
});

test('the length of a prefix is that of counting, with and without an order', () => {
  const falling = [9, 7, 7, 4, 1];
  for (const least of [0, 1, 2, 4, 7, 8, 9, 10]) {
    const inside = (value) => value >= least;
    assert.equal(prefixLength(falling, null, inside), falling.filter(inside).length, `at least ${least}`);
    assert.equal(prefixLength([4, 9, 1, 7, 7], [1, 3, 4, 0, 2], inside), falling.filter(inside).length);
  }
  assert.equal(prefixLength([], null, () => true), 0);
});

test('indices are sorted by descending value, equal ones by themselves', () => {
  assert.deepEqual(Array.from(descending(Float32Array.of(1, 3, 2, 3))), [1, 3, 2, 0]);
  assert.deepEqual(Array.from(descending(Int32Array.of(-1, 0, 0, -2))), [1, 2, 0, 3]);
});
