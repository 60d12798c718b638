-- matrix.lua -- the metatable of tables of expressions that ambit.evaluate takes and gives back in the same shape.
return { __name = "matrix", is_shape = true }
