-- explained.lua -- mutations that no test can notice, or need not: key -> why. They change no answer, make a set wider,
-- or a run slower.
return {
}
