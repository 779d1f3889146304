// Numbers, sizes and times for people, in both pages.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { coordinate, rounded, roundLength, whole } from '../../client/view/web/numbers.js';
import { valuesOf } from '../../client/view/web/probe.js';
import { ago, bytes, count, counted, duration, editable, measure, moment, took, typed } from '../../client/web/page/numbers.js';

// Each input with what is expected of it.
function expectAll(format, pairs) {
  for (const [value, text] of pairs) assert.equal(format(value), text, String(value));
}

test('whole numbers have separators', () => {
  expectAll(whole, [[0, '0'], [999.6, '1,000'], [1234567, '1,234,567']]);
  expectAll(count, [[0, '0'], [12345.4, '12,345']]);
});

test('rounded numbers have four digits, very large and small ones a power of ten', () => {
  expectAll(rounded, [
    [0, '0'],
    [0.123456, '0.1235'],
    [-2.50001, '-2.5'],
    [1234.56, '1,235'],
    [123456, '123,460'],
    [1e-4, '0.0001'],
    [9.99e-5, '9.99 × 10⁻⁵'],
    [1e7, '1 × 10⁷'],
    [-1.23456e12, '-1.235 × 10¹²'],
  ]);
  assert.equal(rounded(1.23456789, 6), '1.23457');
});

test('coordinates are written in full, with a true minus sign', () => {
  expectAll(coordinate, [
    [0, '0'],
    [-1.5, '−1.5'],
    [1234.5678901, '1,234.5678901'],
    [-2e-5, '−2 × 10⁻⁵'],
    [3e8, '3 × 10⁸'],
  ]);
});

test('round lengths are 1, 2 or 5 times a power of ten, and not above the limit', () => {
  expectAll(roundLength, [[1, 1], [1.99, 1], [2, 2], [4.9, 2], [5, 5], [9.9, 5], [70, 50], [0.03, 0.02], [3e-7, 2e-7]]);
});

test('one or many', () => {
  assert.equal(counted(1, 'point'), '1 point');
  assert.equal(counted(0, 'point'), '0 points');
  assert.equal(counted(1200, 'match', 'matches'), '1,200 matches');
});

test('measures have four digits, and all before the point', () => {
  expectAll(measure, [[0, '0'], [12.3456, '12.35'], [1234.56, '1,235'], [16321.4, '16,321'], [0.00123456, '0.001235'], [1e-4, '1.000e-4'], [-2.5e9, '-2.500e9']]);
});

test('what is edited has six digits and no separators', () => {
  expectAll(editable, [[1234567.8, '1234570'], [0.1 + 0.2, '0.3'], [12, '12']]);
});

test('sizes', () => {
  expectAll(bytes, [
    [0, '0 bytes'],
    [1023, '1,023 bytes'],
    [1024, '1.00 KiB'],
    [1536, '1.50 KiB'],
    [100 * 1024 ** 2, '100 MiB'],
    [3 * 1024 ** 4, '3.00 TiB'],
  ]);
});

test('times', () => {
  expectAll(duration, [
    [-3, '0 s'],
    [59.4, '59 s'],
    [59.6, '1 min 00 s'],
    [605, '10 min 05 s'],
    [3600, '1 h 00 min'],
    [86399, '23 h 59 min'],
    [90000, '1 d 1 h'],
  ]);
  assert.equal(ago(Date.now() - 61000), '1 min 01 s ago');
  assert.equal(moment(0), 'not yet');
  assert.match(moment(Date.UTC(2020, 5, 15)), /2020/);
});

test('values under the pointer: E by its share, what is known of the place', () => {
  const model = { facts: { volume: 200 }, coordinates: (place) => place.map((c) => 10 * c) };
  const bare = { share: 0.25, place: [0.1, -0.2, 0], directions: [] };
  assert.deepEqual(valuesOf(model, bare), [
    ['E', '50'],
    ['share of v0', '25 %'],
    ['place', '(1, −2, 0)'],
  ]);
  const full = { ...bare, slope: 0, strength: 0.5, divergence: 7, directions: [[0, 0, 1], [0.7071, -0.7071, 0]] };
  assert.deepEqual(valuesOf(model, full).slice(2), [
    ['slope |∇E|', '0'],
    ['strength', '0.5'],
    ['|H|', '7'],
    ['place', '(1, −2, 0)'],
    ['direction, side 1', '(0, 0, 1)'],
    ['direction, side 2', '(0.71, −0.71, 0)'],
  ]);
});

test('numbers are read as people type them, with a comma or a point', () => {
  expectAll(typed, [['5.5', 5.5], ['5,5', 5.5], [' 12 ', 12], ['1,234', 1234], ['1,234,567.5', 1234567.5], ['10 000', 10000],
    ['1e-3', 1e-3], ['-3', -3], ['0,25', 0.25], ['0,500', 0.5], ['-0,050', -0.05], ['.5', 0.5]]);
  for (const wrong of ['', '1e', 'x', '1.2.3', '1.234,5', '0x10', 'Infinity', '--1']) assert.ok(Number.isNaN(typed(wrong)), wrong);
});

test('what took less than ten seconds has two digits', () => {
  expectAll(took, [[0.3456, '0.35 s'], [2, '2 s'], [9.44, '9.4 s'], [61, '1 min 01 s']]);
});
