; Blocks on a table, moved one at a time. A block is settled once it stands where it shall stay,
; with everything below it settled: then it is never touched again. Each round moves a block to
; its place if one can go there, else takes one out of the way.
;
; Operators and the task achieve-goals are those of the blocks problems which come with SHOP, so
; that their problem files fit this domain as well.

(defdomain blocks-normal (

  (:operator (!pickup ?block)
    ((clear ?block) (on-table ?block))
    ((holding ?block)))
  (:operator (!putdown ?block)
    ((holding ?block))
    ((on-table ?block) (clear ?block)))
  (:operator (!stack ?block ?base)
    ((holding ?block) (clear ?base))
    ((on ?block ?base) (clear ?block)))
  (:operator (!unstack ?block ?base)
    ((clear ?block) (on ?block ?base))
    ((holding ?block) (clear ?base)))

  ; What the search keeps in mind.
  (:operator (!!note ?facts) () ?facts 0)

  (:method (achieve-goals ?goals)
    ((setof (goal ?goal) (assign* ?goal '?goals) ?facts))
    ((!!note ?facts) (settle) (build) (check-goals)))

  ; Settled from the start: what stands on the table or on a settled block, and may stay there.
  (:method (settle)
    (:first (on-table ?block) (not (settled ?block)) (not (goal (on ?block ?base))))
    ((!!note ((settled ?block))) (settle-above ?block) (settle))
    ()
    ())
  (:method (settle-above ?base)
    (:first (on ?block ?base) (may-stay ?block ?base))
    ((!!note ((settled ?block))) (settle-above ?block))
    ()
    ())

  (:- (may-stay ?block ?base) ((goal (on ?block ?base))))
  (:- (may-stay ?block ?base)
    ((not (goal (on ?block ?other))) (not (goal (on-table ?block)))
     (not (goal (on ?another ?base))) (not (goal (clear ?base)))))

  ; The bindings of :first come newest fact first, so the search goes on where it last moved.
  (:method (build)
    to-its-place
    (:first (clear ?block) (not (settled ?block))
            (goal (on ?block ?base)) (settled ?base) (clear ?base))
    ((take ?block) (!stack ?block ?base) (!!note ((settled ?block))) (build))

    to-the-table-for-good
    (:first (clear ?block) (not (settled ?block)) (not (goal (on ?block ?base))))
    ((take ?block) (!putdown ?block) (!!note ((settled ?block))) (build))

    out-of-the-way
    (:first (clear ?block) (not (settled ?block)) (on ?block ?below))
    ((!unstack ?block ?below) (!putdown ?block) (build))

    done
    (forall (?block) ((block ?block)) ((settled ?block)))
    ())

  (:method (take ?block)
    (:first (on ?block ?below))
    ((!unstack ?block ?below))
    ()
    ((!pickup ?block)))

  (:method (check-goals)
    (forall (?goal) ((goal ?goal)) (?goal))
    ())))
