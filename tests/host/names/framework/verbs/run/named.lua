-- named.lua -- wrong on purpose: three texts name plugins, of which one is allowed.
local cheap = { lohner = { order = "8" } }
return cheap, "frame", "real", "take zonotope instead" -- "gsl" in a comment is no text
