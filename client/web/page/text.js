// What words of the protocol mean to people.
import { count, counted, duration, moment } from './numbers.js';
import { session } from './session.js';

/**
 * Title of an artefact, and what it is.
 * @type {Object<string, string[]>}
 */
export const kArtefacts = {
  field: ['Field', 'the erosion level E, its normal and direction at every sample point'],
  divergence: ['Divergence', 'H: how much the optimal normals differ nearby; the published operators keep what has much'],
  skeleton: ['Skeleton', 'sheets and curves; .stl and .off have no place for curves, .csv and .xyz hold the vertices'],
  curve: ['Curve', 'a line through each limb; .json and .graphml: a graph, .swc: trees, .glb: joints of the mesh'],
  thickness: ['Thickness', 'of the body at every triangle: how far the skeleton is below it'],
  eroded: ['Eroded solid', 'where E is at least a share of the volume'],
  mesh: ['Mesh', 'as it was computed'],
  source: ['Mesh before its repair', 'as it was submitted'],
};

const kEvents = {
  submitted_again: 'submitted again',
  cancel_requested: 'asked to cancel',
  removal_planned: 'to be removed',
  task_failed: 'a task failed',
  lease_lost: 'a worker was lost',
  lease_resumed: 'its worker went on',
  leased: 'given to a worker',
  returned: 'given back by a worker',
  adopted: 'took over what was computed before',
  requested: 'a file was asked for',
  request_failed: 'a file could not be made',
  request_withdrawn: 'a file is no longer wanted',
  requests_cancelled: 'files are no longer wanted',
};

/**
 * A word of the protocol as the service words it (`states`, `stages`, `operators`, `frames` or `minima`); one that it
 * does not know, of a later server, as it is.
 * @param {keyof Words} kind
 * @param {string} word
 * @returns {string}
 */
export const wording = (kind, word) => session.words?.[kind][word] || word;

/**
 * The operator of a job: where none was asked for, the usual one.
 * @param {Job} job
 * @returns {string}
 */
export const operatorOf = (job) => wording('operators', job.skeleton.operator || session.usual.operator);

/**
 * An event in words.
 * @param {string} event
 * @returns {string}
 */
export const eventText = (event) => kEvents[event] || event;

/**
 * Whether it waits for a worker or has one.
 * @param {Job} job
 * @returns {boolean}
 */
export const isActive = (job) => job.state === 'queued' || job.state === 'running';

/**
 * Whether retention has taken the results of a finished job.
 * @param {Job} job
 * @returns {boolean}
 */
export const isRemoved = (job) => job.state === 'done' && job.removed_ms > 0;

/**
 * When retention will take what is left of a job; "" when it will not.
 * @param {Job} job
 * @returns {string}
 */
export const expiry = (job) => (job.expires_ms > 0 ? `${job.removed_ms > 0 || !job.prepared ? 'The job and its mesh' : 'Its results'} will be removed on ${moment(job.expires_ms)}, unless it is kept.` : '');

/**
 * What was done to a job's mesh before it was submitted.
 * @param {Job} job
 * @returns {Note[]}
 */
export const repairNotes = (job) =>
  (job.repair?.steps || []).map(({ severity, message }) => (severity === 'warning' ? { severity, message } : { severity: 'repaired', message: `repaired before it was sent: ${message}` }));

/** @param {Job} job */
function skeleton(job) {
  if (job.skeleton_points === 0) return 'the skeleton is empty';
  return job.quality ? `skeleton in ${counted(job.quality.components, 'piece')}` : 'skeleton';
}

/**
 * What a job is doing, or why it does not.
 * @param {Job} job
 * @returns {string}
 */
export function activity(job) {
  if (job.state === 'failed') {
    const { message, line } = job.error || { message: '', line: 0 };
    return (message || 'no reason was given') + (line > 0 ? ` (line ${count(line)} of the file)` : '');
  }
  if (job.cancel_requested && isActive(job)) return 'being cancelled';
  if (job.waiting_reason) return `waits: ${job.waiting_reason}`;
  if (job.state === 'queued') return 'waits for a worker';
  if (job.state === 'running') return wording('stages', job.stage);
  if (isRemoved(job)) return 'its results were removed by the server’s retention; resume computes them again';
  if (job.state === 'done') return `${skeleton(job)} (${operatorOf(job)})`;
  return 'progress is kept; resume goes on from here';
}

/**
 * Directions done of all; while the field goes down to the infimum, points of a round.
 * @param {Job} job
 * @returns {Progress}
 */
export function progressOf(job) {
  if (job.stage !== 'refine') return { done: job.directions_done || 0, total: job.directions_total || 0, unit: 'direction', where: '' };
  return { done: job.refined_points || 0, total: job.prepared?.points || 0, unit: 'point', where: ` in round ${job.refine_round || 0}` };
}

/**
 * What is done of all, with the pace and the time left.
 * @param {Job} job
 * @param {Rate | null} rate
 * @returns {string}
 */
export function progress(job, rate) {
  const { done, total, unit, where } = progressOf(job);
  if (!(total > 0) || job.state === 'done') return '';
  let text = `${count(done)} of ${counted(total, unit)}${where}`;
  if (rate && job.state === 'running' && (job.stage === 'erode' || job.stage === 'refine')) {
    text += `, ${rate.perSecond < 10 ? rate.perSecond.toPrecision(2) : count(rate.perSecond)} per second`;
    if (job.remaining_ms !== undefined) text += `, about ${duration(job.remaining_ms / 1000)} left`;
  }
  return text;
}
