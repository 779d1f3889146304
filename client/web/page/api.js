// Calls of the page's own service.
import { background } from './elements.js';

/** What went wrong, in words for people; `code` as on the command line, `retryAfter` in seconds where that was told. */
export class ApiError extends Error {
  constructor(status, code, message, line) {
    super(message);
    this.status = status;
    this.code = code;
    this.line = line;
    this.retryAfter = 0;
  }
}

/**
 * Whether what was asked for does not come back: it was deleted meanwhile, was never there, or its id is none.
 * @param {any} error
 */
export const isGone = (error) => error?.status === 404 || error?.status === 400;

/**
 * Whether the service, or the server behind it, is not there: the same call may be answered later.
 * @param {any} error
 */
export const isAway = (error) => [0, 502, 503, 504].includes(error?.status);

const kNoAnswer = 'The page gets no answer. Has affskel-client web been ended, or is the network down?';

function errorOf(status, text) {
  try {
    const { code, message, line } = JSON.parse(text).error;
    return new ApiError(status, code, message, line);
  } catch {
    return new ApiError(status, 'INTERNAL', text.trim() || `the answer was status ${status}`);
  }
}

// The session has ended: the sign-in form listens.
function tellSignedOut() {
  document.dispatchEvent(new Event('signed-out'));
}

/**
 * Calls the service.  Throws ApiError.
 * @param {string} method GET, POST or DELETE
 * @param {string} path
 * @param {object} [body] becomes JSON
 * @param {AbortSignal} [signal]
 * @returns {Promise<any>}
 */
export async function call(method, path, body, signal) {
  let response;
  let text;
  try {
    response = await fetch(path, {
      method,
      signal,
      headers: body === undefined ? {} : { 'Content-Type': 'application/json' },
      body: body === undefined ? undefined : JSON.stringify(body),
    });
    text = await response.text();
  } catch (error) {
    if (error.name === 'AbortError') throw error;
    throw new ApiError(0, 'UNREACHABLE', kNoAnswer);
  }
  if (response.ok) return JSON.parse(text);
  const error = errorOf(response.status, text);
  error.retryAfter = Number(response.headers.get('Retry-After'));
  if (error.status === 401 && path !== '/api/session') tellSignedOut();
  throw error;
}

/**
 * The address of a job's calls.
 * @param {string} id
 * @param {string} [rest]
 * @returns {string}
 */
export const jobPath = (id, rest = '') => `/api/jobs/${encodeURIComponent(id)}${rest}`;

/**
 * Sends a file; `progress` gets the share sent.  Throws ApiError.
 * @param {File} file
 * @param {(share: number) => void} progress
 * @param {string} path
 * @param {Asked} asked
 * @returns {Promise<any>}
 */
export function upload(file, progress, path = '/api/meshes', asked = {}) {
  return new Promise((resolve, reject) => {
    const request = new XMLHttpRequest();
    const query = new URLSearchParams({ name: file.name, background: background(), ...asked });
    request.open('POST', `${path}?${query}`);
    request.upload.onprogress = (event) => progress(event.lengthComputable ? event.loaded / event.total : 0);
    request.onerror = () => reject(new ApiError(0, 'UNREACHABLE', kNoAnswer));
    request.onload = () => {
      if (request.status >= 200 && request.status < 300) return resolve(JSON.parse(request.responseText));
      if (request.status === 401) tellSignedOut();
      return reject(errorOf(request.status, request.responseText));
    };
    request.send(file);
  });
}
