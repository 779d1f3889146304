// The user that is signed in, and what the service offers them.
import { call } from './api.js';

/**
 * What the service said last, see Session.
 * @type {Session}
 */
export const session = { mode: 'personal', signed_in: false };

function take(answer) {
  for (const key of Object.keys(session)) delete session[key];
  Object.assign(session, answer);
  return session;
}

const dropKey = () => history.replaceState(null, '', location.pathname);

/**
 * Begins a session by the address, or finds the one that the browser has.  The address's key opens the page once, and
 * leaves the address once it was used: until then the page may be loaded again.
 * @returns {Promise<Session>}
 */
export async function openSession() {
  const key = new URLSearchParams(location.hash.slice(1)).get('key');
  const found = take(await call('GET', '/api/session'));
  if (!key) return session;
  try {
    if (!found.signed_in) take(await call('POST', '/api/session', { key }));
  } catch (error) {
    if (error.status === 401) dropKey();
    throw error;
  }
  dropKey();
  return session;
}

const kMostTries = 15;

/**
 * Where too many wrong tokens came from this address, of others maybe, it asks again when it may, for a while.
 * @param {string} token
 * @returns {Promise<Session>}
 */
export async function signIn(token) {
  for (let tries = 1; ; tries += 1) {
    try {
      return take(await call('POST', '/api/session', { token }));
    } catch (error) {
      if (error.status !== 429 || tries === kMostTries) throw error;
      await new Promise((resolve) => setTimeout(resolve, 1000 * (error.retryAfter || 1)));
    }
  }
}

/**
 * Ends it, here and at the service.
 * @returns {Promise<Session>}
 */
export async function signOut() {
  const { mode } = session;
  await call('DELETE', '/api/session');
  return take({ mode, signed_in: false });
}

/** Ends it here. */
export function forget() {
  take({ mode: session.mode, signed_in: false });
}
