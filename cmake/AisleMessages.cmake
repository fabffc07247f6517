# Bounded C structs, decoders and encoders from lcmtypes/*.lcm: messages.h and the field tables.
find_package(Python3 REQUIRED COMPONENTS Interpreter)
file(GLOB AISLE_LCM_FILES CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/lcmtypes/*.lcm)
set(AISLE_CODEGEN ${CMAKE_CURRENT_SOURCE_DIR}/tools/codegen/lcm_codec.py)
set(AISLE_MESSAGES_INCLUDE ${CMAKE_CURRENT_BINARY_DIR}/gen/include)
set(AISLE_MESSAGES_HEADER ${AISLE_MESSAGES_INCLUDE}/aisle/messages.h)
set(AISLE_MESSAGES_TABLES ${CMAKE_CURRENT_BINARY_DIR}/gen/wire/tables.c)
add_custom_command(
  OUTPUT ${AISLE_MESSAGES_HEADER} ${AISLE_MESSAGES_TABLES}
  COMMAND ${Python3_EXECUTABLE} ${AISLE_CODEGEN} --header ${AISLE_MESSAGES_HEADER} --tables ${AISLE_MESSAGES_TABLES}
          ${AISLE_LCM_FILES}
  DEPENDS ${AISLE_LCM_FILES} ${AISLE_CODEGEN}
  COMMENT "Generating bounded message codecs")
add_custom_target(aisle_messages DEPENDS ${AISLE_MESSAGES_HEADER} ${AISLE_MESSAGES_TABLES})
