# The Debian package: `make deb` builds it into out/, `make deb-check` installs and tries it in a bare root. The top Makefile includes this.
# Other goals have no use for it, and need no dpkg.
.PHONY: deb deb-check
ifneq ($(filter deb deb-check out/sinew_%.deb,$(MAKECMDGOALS)),)

VERSION := $(shell sed -n 's/^.define SINEW_VERSION "\(.*\)"/\1/p' common/cli/tool.h)
DEB := out/sinew_$(VERSION)_$(shell dpkg --print-architecture).deb
# dpkg-buildpackage writes beside the folder that it is called in, so that has to be a copy. It stays where the build fails.
DEB_TREE = out/deb/sinew-$(VERSION)
DEB_FOLDERS = attach bind common debian man msds samples slice tled voxelise
DEB_FILES = Makefile LICENSE $(wildcard *.md)
DEB_JOBS = $(or $(patsubst -j%,%,$(filter -j%,$(MAKEFLAGS))),$(shell nproc 2>/dev/null || echo 2))
# Nothing of this make's own goes into that of the package, but for CUDA and where it is.
DEB_ENVIRONMENT = env -u MAKEFLAGS -u MFLAGS -u MAKELEVEL -u MAKEOVERRIDES -u DESTDIR \
	CUDA='$(CUDA)' NVCC='$(NVCC)' CUDA_HOME='$(CUDA_HOME)' DEB_BUILD_OPTIONS='noautodbgsym parallel=$(DEB_JOBS)'

deb:
	.ci/setup deb
	$(MAKE) --no-print-directory $(DEB)
	@if command -v lintian >/dev/null; then lintian --allow-root --fail-on error,warning $(DEB) && echo 'lintian: no errors and no warnings'; \
	    else echo 'lintian: not installed, so the package was not checked by it'; fi
	@echo $(DEB) && dpkg-deb --field $(DEB) Description | sed -n '/^ This build/,$$p'

deb-check: deb
	.ci/setup deb-check
	tests/deb/check $(DEB)

DEB_SOURCES := $(shell find $(DEB_FOLDERS) -type f) tests/check.mk $(DEB_FILES)
$(DEB): $(DEB_SOURCES) $(BUILD)/deb-cuda-$(CUDA)
	rm -rf $(dir $(DEB_TREE))
	mkdir -p $(DEB_TREE)
	tar -c $(DEB_FOLDERS) tests $(DEB_FILES) | tar -x -C $(DEB_TREE)
	cd $(DEB_TREE) && $(DEB_ENVIRONMENT) dpkg-buildpackage --build=binary --no-sign
	mv $(dir $(DEB_TREE))$(@F) $@
	rm -rf $(dir $(DEB_TREE))

# A package made with CUDA is none made without.
$(BUILD)/deb-cuda-$(CUDA):
	@mkdir -p $(@D)
	@rm -f $(BUILD)/deb-cuda-*
	@touch $@

endif
