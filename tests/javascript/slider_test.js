// slider.js: from the place of a slider to round values and back.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Slider, Stops } from '../../client/view/web/slider.js';
import { fakeElement } from './fake_document.js';

// A slider with its parts and the values that it told.
function made(Kind, options) {
  const [range, field, told] = [fakeElement('input'), fakeElement('input'), []];
  const root = { querySelector: (selector) => (selector.includes('range') ? range : field) };
  const slider = new Kind(root, { ...options, changed: (value) => told.push(value) });
  return { slider, range, field, told };
}

test('a slider goes over its range, rounding down to three digits but not below its low end', () => {
  const { slider, range, field, told } = made(Slider, { low: 0.7004, high: 123.456 });
  assert.equal(range.max, 1000);
  for (const place of [0, 1, 500, 1000]) range.give(place, 'input');
  assert.deepEqual(told, [0.7004, 0.823, 62, 123]);
  assert.equal(field.value, '123');
  assert.equal(range.attributes['aria-valuetext'], '123');
  assert.equal(slider.value, 123);
});

test('a round value stays itself', () => {
  const { slider } = made(Slider, { low: 0, high: 10 });
  for (const value of [0.29, 0.57, 1.15, 7, 8.21]) assert.equal(slider.round(value), value);
});

test('a curve gives small values more room', () => {
  const { slider, range, told } = made(Slider, { low: 0, high: 1, curve: 3 });
  range.give(500, 'input');
  assert.deepEqual(told, [0.125]);
  slider.set(0.008);
  assert.equal(range.value, 200);
});

test('the field takes any value within the range, and nothing else', () => {
  const { slider, range, field, told } = made(Slider, { low: 1, high: 11 });
  field.give(3.14159, 'change');
  assert.equal(range.value, 214);
  assert.equal(field.value, '3.1416');
  field.give(100, 'change');
  field.give(-1, 'change');
  slider.set(5);
  field.give('', 'change');
  field.give('2,5', 'change');
  field.give('half', 'change');
  assert.deepEqual(told, [3.14159, 11, 1, 5, 2.5, 2.5]);
});

test('a range without length keeps its only value', () => {
  const { slider, range } = made(Slider, { low: 2, high: 2 });
  slider.set(7);
  assert.equal(slider.value, 2);
  assert.equal(range.value, 0);
});

test('stops are stood at, and the nearest is found', () => {
  const { slider, range, field, told } = made(Stops, { values: [1, 5, 12.345678] });
  assert.equal(range.max, 2);
  range.give(2, 'input');
  assert.equal(field.value, '12.346');
  field.give(3.5, 'change');
  assert.equal(range.value, 1);
  field.give('', 'change');
  field.give('0,5', 'change');
  assert.deepEqual(told, [2, 1, 1, 0]);
  assert.deepEqual([-9, 2, 4, 99].map((value) => slider.nearest(value)), [0, 0, 1, 2]);
});
