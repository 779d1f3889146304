# Run by CPack on the staged files of every component, before they become packages: what an installation has under one
# prefix goes where Debian wants it, /etc and /lib beside /usr, and texts that Debian compresses are compressed.
file(GLOB stages LIST_DIRECTORIES true ${CPACK_TEMPORARY_INSTALL_DIRECTORY}/*)
foreach(stage ${stages})
  if(EXISTS ${stage}/usr/etc)
    file(RENAME ${stage}/usr/etc ${stage}/etc)
  endif()
  if(EXISTS ${stage}/usr/lib/systemd)
    file(MAKE_DIRECTORY ${stage}/lib)
    file(RENAME ${stage}/usr/lib/systemd ${stage}/lib/systemd)
    file(REMOVE_RECURSE ${stage}/usr/lib)
  endif()
  file(GLOB texts ${stage}/usr/share/man/man*/*.[1-8] ${stage}/usr/share/doc/*/changelog
    ${stage}/usr/share/doc/*/changelog.Debian)
  foreach(text ${texts})
    # Without name and time, so that the same build makes the same package.
    execute_process(COMMAND gzip -9nf ${text} COMMAND_ERROR_IS_FATAL ANY)
  endforeach()
endforeach()
