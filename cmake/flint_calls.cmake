# Lists the functions of FLINT that a library calls, for src/certify/late/calls.S:
#   cmake -DNM=nm -DLIBRARY=libcarom.a -DOUTPUT=FILE -P flint_calls.cmake
execute_process(COMMAND ${NM} -u ${LIBRARY} OUTPUT_VARIABLE symbols ERROR_QUIET COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "U _?(acb|arb|arf|flint|fmpq|fmpz|mag)_[A-Za-z0-9_]+" calls "${symbols}")
list(SORT calls)
list(REMOVE_DUPLICATES calls)
list(TRANSFORM calls REPLACE "^U " "flint_call ")
list(JOIN calls "\n" text)
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "${text}\n" @ONLY)
