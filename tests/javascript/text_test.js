// text.js: jobs in words, which are the service's; and that the pages know no state or stage that the contract has not.
/* eslint-env node */
import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import { test } from 'node:test';
import { session } from '../../client/web/page/session.js';
import {
  activity,
  eventText,
  expiry,
  isActive,
  isRemoved,
  operatorOf,
  progress,
  repairNotes,
  wording,
} from '../../client/web/page/text.js';

const kJob = { skeleton: {}, directions_total: 0, directions_done: 0, removed_ms: 0, expires_ms: 0 };

session.words = {
  states: { queued: 'in line' },
  stages: { erode: 'at sea' },
  operators: { flux: 'the flow', ridge: 'the crest' },
  frames: {},
};
session.usual = { operator: 'ridge', frame: 'axis' };

test('a repair is told with its warnings as warnings', () => {
  const steps = [
    { code: 'wrapped', severity: 'repaired', message: 'wrapped by 8 triangles' },
    { code: 'closed-cavities', severity: 'warning', message: '1 cavity closed' },
    { code: 'filled-holes', severity: '', message: '1 hole filled' }, // by an older client
  ];
  assert.deepEqual(repairNotes({ ...kJob, repair: { steps } }), [
    { severity: 'repaired', message: 'repaired before it was sent: wrapped by 8 triangles' },
    { severity: 'warning', message: '1 cavity closed' },
    { severity: 'repaired', message: 'repaired before it was sent: 1 hole filled' },
  ]);
  assert.deepEqual(repairNotes(kJob), []);
});

test('words are those of the service, and of a later server as they are', () => {
  assert.equal(wording('states', 'queued'), 'in line');
  assert.equal(wording('states', 'dreaming'), 'dreaming');
  assert.equal(operatorOf({ skeleton: { operator: 'flux' } }), 'the flow');
  assert.equal(operatorOf({ skeleton: {} }), 'the crest');
  assert.equal(eventText('lease_lost'), 'a worker was lost');
  assert.equal(eventText('new_thing'), 'new_thing');
});

test('what a job is doing, or why it does not', () => {
  const tell = (job) => activity({ ...kJob, ...job });
  assert.equal(tell({ state: 'failed', error: { message: 'a hole', line: 1200 } }), 'a hole (line 1,200 of the file)');
  assert.equal(tell({ state: 'failed' }), 'no reason was given');
  assert.equal(tell({ state: 'running', cancel_requested: true }), 'being cancelled');
  assert.equal(tell({ state: 'queued', waiting_reason: 'the quota' }), 'waits: the quota');
  assert.equal(tell({ state: 'queued' }), 'waits for a worker');
  assert.equal(tell({ state: 'running', stage: 'erode' }), 'at sea');
  assert.equal(tell({ state: 'done', skeleton_points: 9, quality: { components: 1 } }), 'skeleton in 1 piece (the crest)');
  assert.equal(tell({ state: 'done', skeleton_points: 0, quality: { components: 0 } }), 'the skeleton is empty (the crest)');
  assert.match(tell({ state: 'done', removed_ms: 5 }), /retention/);
  assert.match(tell({ state: 'cancelled', cancel_requested: true }), /resume goes on/);
});

test('who is active, and whose results are gone', () => {
  assert.deepEqual(
    ['queued', 'running', 'done', 'failed', 'cancelled'].map((state) => isActive({ state })),
    [true, true, false, false, false],
  );
  assert.ok(isRemoved({ state: 'done', removed_ms: 1 }));
  assert.ok(!isRemoved({ state: 'done', removed_ms: 0 }) && !isRemoved({ state: 'failed', removed_ms: 1 }));
  assert.equal(expiry(kJob), '');
  assert.match(expiry({ ...kJob, expires_ms: 1, prepared: {} }), /^Its results will be removed on /);
  assert.match(expiry({ ...kJob, expires_ms: 1 }), /^The job and its mesh will/);
  assert.match(expiry({ ...kJob, expires_ms: 1, removed_ms: 1 }), /^The job and its mesh will/);
});

test('progress, with pace and time left while directions are eroded', () => {
  const job = { ...kJob, state: 'running', stage: 'erode', directions_total: 2000, directions_done: 1000 };
  assert.equal(progress(job, null), '1,000 of 2,000 directions');
  assert.equal(
    progress({ ...job, remaining_ms: 61000 }, { perSecond: 9.87 }),
    '1,000 of 2,000 directions, 9.9 per second, about 1 min 01 s left',
  );
  assert.equal(progress({ ...job, stage: 'derive' }, { perSecond: 1 }), '1,000 of 2,000 directions');
  const refining = { ...job, stage: 'refine', refine_round: 3, refined_points: 250, prepared: { points: 9000 } };
  assert.equal(progress(refining, { perSecond: 100 }), '250 of 9,000 points in round 3, 100 per second');
  assert.equal(progress({ ...job, state: 'done' }, null), '');
  assert.equal(progress(kJob, null), '');
});

test('what the pages compare states and stages with are words of the contract', () => {
  const { AFFSKEL_SOURCE: root } = process.env;
  const contract = readFileSync(`${root}/proto/affskel/v1/types.proto`, 'utf8');
  const page = `${root}/client/web/page`;
  const sources = readdirSync(page)
    .filter((name) => name.endsWith('.js'))
    .map((name) => readFileSync(`${page}/${name}`, 'utf8'));
  for (const kind of ['state', 'stage']) {
    const compared = sources.flatMap((text) =>
      Array.from(text.matchAll(new RegExp(`\\b${kind} [!=]== '([^']*)'`, 'g')), ([, word]) => word),
    );
    assert.ok(compared.length > 0);
    for (const word of compared) {
      const value = `JOB_${kind}_${word}`.toUpperCase().replace(/-/g, '_');
      assert.match(contract, new RegExp(`^  ${value} = [1-9]`, 'm'), `${kind} '${word}'`);
    }
  }
});

test('the pages have no words of operators and frames of their own', () => {
  const { AFFSKEL_SOURCE: root } = process.env;
  const contract = readFileSync(`${root}/proto/affskel/v1/types.proto`, 'utf8');
  const words = Array.from(contract.matchAll(/^ {2}(?:OPERATOR|FRAME)_(\w+) = [1-9]/gm), ([, word]) =>
    word.toLowerCase().replace(/_/g, '-'),
  );
  assert.ok(words.includes('zucker-hummel') && words.includes('obb'));
  for (const folder of [`${root}/client/web/page`, `${root}/client/view/web`]) {
    for (const name of readdirSync(folder).filter((file) => file.endsWith('.js'))) {
      const text = readFileSync(`${folder}/${name}`, 'utf8');
      for (const word of words) assert.ok(!text.includes(`'${word}'`), `${name}: '${word}'`);
    }
  }
});
