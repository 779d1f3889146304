// link.js: what is seen, to the fragment of the address and back.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Link, readLink, writeLink } from '../../client/view/web/link.js';

const kSeen = {
  view: '',
  azimuth: -33.25,
  elevation: 12.5,
  zoom: 2,
  target: [0.25, 0, -0.5],
  thresholds: [7.5, 0.005],
  level: 10,
  shown: ['mesh', 'skeleton'],
  opacity: 20,
  clip: 'x<0.25',
};

test('what is seen comes back', () => {
  const { view, ...seen } = kSeen;
  assert.equal(view, '');
  assert.deepEqual(readLink(`#${writeLink(kSeen)}`), { ...seen, clip: { axis: 'x', beyond: '<', at: 0.25 } });
  assert.deepEqual(readLink(writeLink({ ...kSeen, clip: 'z>-1e-3' })).clip, { axis: 'z', beyond: '>', at: -1e-3 });
});

test('a link reads well, to six digits', () => {
  assert.equal(
    writeLink({ ...kSeen, azimuth: 1 / 3 }),
    'camera=0.333333,12.5,2&at=0.25,0,-0.5&threshold=7.5,0.005&level=10&show=mesh,skeleton&opacity=20&clip=x%3C0.25',
  );
});

test('a chosen view stands for its camera, and a target in the middle for itself', () => {
  const front = writeLink({ ...kSeen, view: 'front' });
  assert.match(front, /^view=front&threshold=/);
  assert.equal(readLink(front).view, 'front');
  assert.ok(!('azimuth' in readLink(front)));
  const middle = writeLink({ ...kSeen, target: [1e-9, 0, 0] });
  assert.ok(!middle.includes('at='));
  assert.deepEqual(readLink(middle).target, [0, 0, 0]);
});

test('what may be absent is', () => {
  const seen = readLink(writeLink({ ...kSeen, opacity: null, clip: '', shown: [] }));
  assert.ok(!('opacity' in seen) && !('clip' in seen));
  assert.deepEqual(seen.shown, ['']); // no layer has this name
});

test('what is no link, or beyond what anybody looks at, is passed over', () => {
  for (const text of [
    '',
    '#',
    '#nonsense',
    '#view=behind',
    '#camera=1,2',
    '#camera=1,2,x',
    '#camera=1,,2',
    '#camera=1,91,1',
    '#camera=1,2,0',
    '#camera=1,2,1001',
    '#camera=1,2,Infinity',
    '#threshold=',
    '#threshold=7,x',
    '#level=deep',
    '#opacity=%20',
    '#clip=w%3C1',
    '#clip=x%3C1-1',
    '#clip=x1',
  ]) {
    assert.deepEqual(readLink(text), {}, text);
  }
});

test('of a bad link what is good is taken', () => {
  assert.deepEqual(readLink('#camera=bad&threshold=3&level=x&show=mesh'), { thresholds: [3], shown: ['mesh'] });
  assert.deepEqual(readLink('#camera=10,20,1&at=1,2').target, [0, 0, 0]);
  assert.deepEqual(readLink('#camera=10,20,1&at=1,2,1e4').target, [0, 0, 0]);
  assert.equal(readLink('#camera=10,-90,0.001').elevation, -90);
});

test('of many changes the last is in the address, and a frame without one is none', async () => {
  const seen = [];
  const told = [];
  const listeners = {};
  globalThis.window = {
    location: { hash: '#level=5' },
    addEventListener: (name, listener) => (listeners[name] = listener),
    history: { replaceState: (_, __, text) => seen.push(text) },
    parent: { postMessage: (message) => told.push(message) },
  };
  const opened = [];
  let now = 1;
  const link = new Link(() => `level=${now}`, (text) => opened.push(text));
  link.update();
  now = 2;
  link.update();
  await new Promise((resolve) => setTimeout(resolve, 300));
  assert.deepEqual(seen, ['#level=2']);
  assert.deepEqual(told, [{ affskelLink: 'level=2' }], 'what shows the page in a frame knows, too');
  listeners.hashchange();
  assert.deepEqual(opened, ['#level=5']);
  window.parent = window;
  window.history.replaceState = () => {
    throw Object.assign(new Error(), { name: 'SecurityError' });
  };
  link.update();
  await new Promise((resolve) => setTimeout(resolve, 300));
});
